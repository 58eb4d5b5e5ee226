#include "daemon/config/document_reader.hpp"

// toml++ 3.3 states some of its expectations of the input as assumptions to the compiler: "[=" in a file
// aborts a build with assertions and is undefined behaviour without. The code behind each one reports an
// error of its own, so the assumptions are left out.
#define TOML_EXCEPTIONS 0
#include <toml++/impl/preprocessor.h>
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT_ASSUME(expr) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "daemon/config/key_table.hpp"
#include "daemon/config/nearest_name.hpp"
#include "daemon/config/value_text.hpp"

namespace hulltrack {
namespace {

constexpr std::size_t kMaxLidars = 16;

int line_of(const toml::source_region& region) { return static_cast<int>(region.begin.line); }

std::string joined(const std::string& path, std::string_view name) {
  return path.empty() ? std::string(name) : path + '.' + std::string(name);
}

std::string shortened(std::string text) {
  constexpr std::size_t kMost = 80;
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

std::optional<Numbers> numbers_of(const toml::node& node) {
  const toml::array* list = node.as_array();
  if (list == nullptr) {
    return std::nullopt;
  }
  Numbers numbers;
  for (const toml::node& item : *list) {
    const auto number = item.is_number() ? item.value<double>() : std::nullopt;
    if (!number || !std::isfinite(*number)) {
      return std::nullopt;
    }
    numbers.push_back(*number);
  }
  return numbers;
}

/// The node as the alternative that `like` holds; nothing when it is of another type or not finite.
/// Whole numbers are taken where fractions are allowed, not the other way round.
struct Converter {
  const toml::node& node;

  std::optional<ConfigValue> operator()(bool) const { return exactly<bool>(); }
  std::optional<ConfigValue> operator()(std::int64_t) const { return exactly<std::int64_t>(); }
  std::optional<ConfigValue> operator()(const std::string&) const { return exactly<std::string>(); }
  std::optional<ConfigValue> operator()(double) const {
    const auto number = node.is_number() ? node.value<double>() : std::nullopt;
    return number && std::isfinite(*number) ? std::optional<ConfigValue>(*number) : std::nullopt;
  }
  std::optional<ConfigValue> operator()(const Numbers&) const {
    auto numbers = numbers_of(node);
    return numbers ? std::optional<ConfigValue>(std::move(*numbers)) : std::nullopt;
  }
  std::optional<ConfigValue> operator()(const std::vector<Numbers>&) const {
    const toml::array* list = node.as_array();
    if (list == nullptr) {
      return std::nullopt;
    }
    std::vector<Numbers> lists;
    for (const toml::node& item : *list) {
      auto numbers = numbers_of(item);
      if (!numbers) {
        return std::nullopt;
      }
      lists.push_back(std::move(*numbers));
    }
    return lists;
  }

 private:
  template <typename T>
  std::optional<ConfigValue> exactly() const {
    const auto value = node.value_exact<T>();
    return value ? std::optional<ConfigValue>(*value) : std::nullopt;
  }
};

std::string described(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) {
    return "the text " + toml_text(*text);
  }
  if (const auto whole = node.value_exact<std::int64_t>()) {
    return std::to_string(*whole);
  }
  if (const auto number = node.value_exact<double>()) {
    return number_text(*number);
  }
  if (const auto flag = node.value_exact<bool>()) {
    return *flag ? "true" : "false";
  }
  if (const auto numbers = numbers_of(node)) {
    return toml_text(*numbers);
  }
  return node.is_array() ? "a list" : node.is_table() ? "a table" : "a date or time";
}

class Reader {
 public:
  Reader(std::string file, int last_line, const std::vector<std::string>& models, Document& out)
      : file_(std::move(file)), last_line_(last_line), models_(models), out_(out) {}

  void read(const toml::table& root) {
    auto sections = config_sections(out_.config);
    read_table(root, "", "", sections);
    report_missing_sections(sections, "");
    if (!root.contains(kLidarSection)) {
      report(last_line_, kLidarSection, "missing; give at least one [[lidar]] section");
    }
  }

 private:
  /// `path` names the table as the key table does, `place` with the index of its LiDAR.
  void read_table(const toml::table& table, const std::string& path, const std::string& place,
                  std::vector<Section>& sections) {
    visited_.insert(place);
    out_.lines[place] = line_of(table.source());
    Section* section = find_section(sections, path);
    for (const auto& [name, node] : table) {
      const std::string child = joined(path, name.str());
      const int line = line_of(name.source());
      out_.lines[joined(place, name.str())] = line;
      if (Key* key = section != nullptr ? find_key(*section, name.str()) : nullptr) {
        read_key(node, *key, child, joined(place, name.str()), line);
      } else if (child == kLidarSection) {
        read_lidars(node, line);
      } else if (!is_section(sections, child)) {
        report(line, child,
               unknown(node.is_table() || node.is_array_of_tables(), path, name.str(), sections));
      } else if (const toml::table* inner = node.as_table()) {
        read_table(*inner, child, joined(place, name.str()), sections);
      } else {
        visited_.insert(joined(place, name.str()));
        report(line, child, "is " + described(node) + "; must be a table, [" + child + "]");
      }
    }
    if (section != nullptr) {
      report_missing_keys(*section, table, line_of(table.source()));
    }
  }

  void read_key(const toml::node& node, const Key& key, const std::string& name, const std::string& place,
                int line) {
    const auto value = std::visit(Converter{node}, key.get());
    if (value && key.legal(*value)) {
      key.set(*value);
      return;
    }
    std::string message =
        "is " + shortened(value ? toml_text(*value) : described(node)) + "; must be " + key.allowed;
    if (value && std::holds_alternative<std::string>(*value)) {
      if (const auto near = nearest_name(std::get<std::string>(*value), key.words)) {
        message += "; did you mean \"" + *near + "\"?";
      }
    }
    out_.bad_keys.insert(place);
    report(line, name, message);
  }

  void read_lidars(const toml::node& node, int line) {
    const toml::array* list = node.as_array();
    const bool tables =
        list != nullptr &&
        std::all_of(list->begin(), list->end(), [](const toml::node& item) { return item.is_table(); });
    if (!tables) {
      report(line, kLidarSection, "is " + described(node) + "; LiDARs are written as [[lidar]] sections");
    } else if (list->empty() || list->size() > kMaxLidars) {
      report(line, kLidarSection,
             "there are " + std::to_string(list->size()) + "; give 1 to " + std::to_string(kMaxLidars) +
                 " [[lidar]] sections");
    } else {
      for (std::size_t i = 0; i < list->size(); ++i) {
        LidarConfig lidar;
        auto sections = lidar_sections(lidar, models_);
        read_table(*list->get(i)->as_table(), kLidarSection, joined(kLidarSection, std::to_string(i)),
                   sections);
        out_.config.lidars.push_back(lidar);
      }
    }
  }

  void report_missing_keys(const Section& section, const toml::table& table, int line) {
    for (const Key& key : section.keys) {
      if (key.required && !table.contains(key.name)) {
        report(line, joined(section.name, key.name), "missing; must be " + key.allowed);
      }
    }
  }

  void report_missing_sections(const std::vector<Section>& sections, const std::string& prefix) {
    static const toml::table nothing;
    for (const Section& section : sections) {
      if (!visited_.contains(prefix + section.name)) {
        report_missing_keys(section, nothing, last_line_);
      }
    }
  }

  static Section* find_section(std::vector<Section>& sections, const std::string& path) {
    const auto found =
        std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == path; });
    return found == sections.end() ? nullptr : &*found;
  }

  static Key* find_key(Section& section, std::string_view name) {
    const auto found =
        std::find_if(section.keys.begin(), section.keys.end(), [&](const Key& k) { return k.name == name; });
    return found == section.keys.end() ? nullptr : &*found;
  }

  /// A section itself or a table on the way to one.
  static bool is_section(const std::vector<Section>& sections, const std::string& path) {
    return std::any_of(sections.begin(), sections.end(), [&](const Section& section) {
      return section.name == path || section.name.starts_with(path + '.');
    });
  }

  /// What to say about a name that is neither a key nor a section.
  static std::string unknown(bool is_table, const std::string& path, std::string_view name,
                             const std::vector<Section>& sections) {
    const std::string prefix = path.empty() ? "" : path + '.';
    std::vector<std::string> known;  // that may stand in this table
    std::string elsewhere;
    for (const Section& section : sections) {
      if (section.name.starts_with(prefix)) {
        const std::string rest = section.name.substr(prefix.size());
        known.push_back(rest.substr(0, rest.find('.')));
      }
      for (const Key& key : section.keys) {
        if (section.name == path) {
          known.push_back(key.name);
        } else if (key.name == name) {
          elsewhere = section.name;
        }
      }
    }
    if (path.empty()) {
      known.emplace_back(kLidarSection);
    }
    known.erase(std::unique(known.begin(), known.end()), known.end());
    const std::string message = is_table ? "unknown section" : "unknown key";
    if (const auto near = nearest_name(name, known)) {
      return message + "; did you mean " + prefix + *near + '?';
    }
    if (!elsewhere.empty()) {
      return message + "; it belongs into [" + elsewhere + ']';
    }
    std::string list;
    for (const std::string& item : known) {
      list += (list.empty() ? "" : ", ") + item;
    }
    return message + "; known here: " + list;
  }

  void report(int line, const std::string& key, const std::string& message) {
    out_.problems.push_back({file_, line, key + ": " + message});
  }

  std::string file_;
  int last_line_;
  const std::vector<std::string>& models_;
  Document& out_;
  std::set<std::string> visited_;  // places of tables that were there
};

}  // namespace

Document read_document(std::string_view text, const std::string& file,
                       const std::vector<std::string>& models) {
  Document document;
  const toml::parse_result parsed = toml::parse(text);
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    std::string what(error.description());
    std::replace(what.begin(), what.end(), '\n', ' ');
    const bool twice = what.find("redefine") != std::string::npos;
    document.problems.push_back(
        {file, std::max(1, line_of(error.source())),
         "TOML syntax: " + what +
             (twice ? "; each key and section may be given once" : "; see https://toml.io")});
    return document;
  }
  const auto breaks = std::count(text.begin(), text.end(), '\n');
  const int last_line = std::max(1, static_cast<int>(breaks) + (text.empty() || text.back() == '\n' ? 0 : 1));
  Reader(file, last_line, models, document).read(parsed.table());
  return document;
}

}  // namespace hulltrack
