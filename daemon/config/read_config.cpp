#include "daemon/config/read_config.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "daemon/config/cross_rules.hpp"
#include "daemon/config/document_reader.hpp"
#include "daemon/config/key_table.hpp"

namespace hulltrack {
namespace {

// Far more than any real file; they bound the depth of what the TOML parser builds.
constexpr std::size_t kMaxFile = 1 << 20;
constexpr std::size_t kMaxLine = 4096;

/// "lidar.0.port" -> "lidar.port", as a person writes it.
std::string without_index(const std::string& key) {
  std::string out;
  std::istringstream parts(key);
  for (std::string part; std::getline(parts, part, '.');) {
    if (part.find_first_not_of("0123456789") != std::string::npos) {
      out += (out.empty() ? "" : ".") + part;
    }
  }
  return out;
}

using Lines = std::map<std::string, int>;

/// Of the first key that stands in the file, else of the nearest table around the first of them.
int line_to_blame(const std::vector<std::string>& keys, const Lines& lines) {
  for (const std::string& key : keys) {
    if (const auto found = lines.find(key); found != lines.end()) {
      return found->second;
    }
  }
  for (std::string place = keys.front(); place.find('.') != std::string::npos;) {
    place.erase(place.rfind('.'));
    if (const auto found = lines.find(place); found != lines.end()) {
      return found->second;
    }
  }
  return 1;
}

void add_broken_rules(Document& document, std::span<const LidarModel> models, const std::string& file) {
  for (const BrokenRule& rule : check_cross_rules(document.config, models)) {
    const bool known_bad = std::any_of(rule.keys.begin(), rule.keys.end(), [&](const std::string& key) {
      return document.bad_keys.contains(key);
    });
    if (!known_bad) {
      for (const std::string& key : rule.keys) {
        document.blamed.insert(key.substr(0, key.find('.')));
      }
      document.problems.push_back({file, line_to_blame(rule.keys, document.lines),
                                   without_index(rule.keys.front()) + ": " + rule.message});
    }
  }
}

/// Whether all that [plc] holds is meant as it stands. A name at the root that nobody knows may be a part of
/// it, misspelt, so that a default stands in its place: registers would be written at an address of another.
bool plc_is_good(Document& document) {
  std::set<std::string> known{kLidarSection};
  for (const Section& section : config_sections(document.config)) {
    known.insert(section.name.substr(0, section.name.find('.')));
  }
  return !document.lines.empty() && !document.blamed.contains("plc") &&
         std::ranges::includes(known, document.blamed);
}

/// The first line that is too long, or nothing.
std::optional<Problem> find_long_line(std::string_view text, const std::string& file) {
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kMaxLine) {
      return Problem{file, line,
                     "the line is longer than " + std::to_string(kMaxLine) + " characters; break it"};
    }
    begin = end + 1;
  }
  return std::nullopt;
}

void resolve_paths(Config& config, const std::filesystem::path& file) {
  std::error_code ignored;
  const auto folder = std::filesystem::absolute(file, ignored).parent_path();
  if (!config.map_file.empty()) {
    config.map_file = (folder / config.map_file).lexically_normal();
  }
  if (!config.quay_file.empty()) {
    config.quay_file = (folder / config.quay_file).lexically_normal();
  }
  for (LidarConfig& lidar : config.lidars) {
    if (!lidar.calibration.empty()) {
      lidar.calibration = (folder / lidar.calibration).lexically_normal().string();
    }
  }
}

ConfigReading without_config(Problem problem) {
  ConfigReading reading;
  reading.problems.push_back(std::move(problem));
  return reading;
}

}  // namespace

Problem ConfigReading::problem_with(const std::filesystem::path& file, const std::string& key,
                                    const std::string& message) const {
  return {file.string(), line_to_blame({key}, lines), without_index(key) + ": " + message};
}

ConfigReading parse_config(std::string_view text, const std::filesystem::path& file,
                           std::span<const LidarModel> models) {
  const std::string name = file.string();
  if (text.size() > kMaxFile) {
    return without_config({name, 0, "is larger than 1 MiB; is this the configuration?"});
  }
  if (const auto long_line = find_long_line(text, name)) {
    return without_config(*long_line);
  }
  Document document = read_document(text, name, models);
  if (!document.lines.empty()) {  // otherwise it is not even TOML
    add_broken_rules(document, models, name);
  }
  sort_by_line(document.problems);
  const bool plc_good = plc_is_good(document);
  resolve_paths(document.config, file);
  ConfigReading reading{.config = {},
                        .problems = std::move(document.problems),
                        .lines = std::move(document.lines),
                        .readable = std::move(document.config),
                        .bad_keys = std::move(document.bad_keys),
                        .plc = {}};
  if (plc_good) {
    reading.plc = reading.readable.plc;
  }
  if (reading.problems.empty()) {
    reading.config = reading.readable;
  }
  return reading;
}

Result<std::string> read_config_text(const std::filesystem::path& file) {
  const auto failed = [&](const std::string& why) {
    return Error{"cannot be read: " + why + "; is this the right file?"};
  };
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) {
    return failed("it is a folder");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    return failed(std::strerror(errno));
  }
  std::string text(kMaxFile + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) {
    return failed(std::strerror(errno));
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

ConfigReading read_config(const std::filesystem::path& file, std::span<const LidarModel> models) {
  const Result<std::string> text = read_config_text(file);
  return text ? parse_config(*text, file, models) : without_config({file.string(), 0, text.error().message});
}

}  // namespace hulltrack
