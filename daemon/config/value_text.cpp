#include "daemon/config/value_text.hpp"

#include <array>
#include <charconv>
#include <cstdio>

namespace hulltrack {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\u%04X", static_cast<unsigned>(byte));
      out += escape.data();
    } else {
      out += c;
    }
  }
  return out + '"';
}

template <typename T, typename Text>
std::string bracketed(const std::vector<T>& items, Text text) {
  std::string out = "[";
  for (const T& item : items) {
    out += (out.size() > 1 ? ", " : "") + text(item);
  }
  return out + ']';
}

std::string numbers_text(const Numbers& numbers) { return bracketed(numbers, number_text); }

struct TomlText {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return number_text(value); }
  std::string operator()(const std::string& value) const { return quoted(value); }
  std::string operator()(const Numbers& value) const { return numbers_text(value); }
  std::string operator()(const std::vector<Numbers>& value) const { return bracketed(value, numbers_text); }
};

}  // namespace

std::string number_text(double value) {
  std::array<char, 40> buffer{};
  const auto [end, failure] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), end);
  if (text.find_first_of(".en") == std::string::npos) {
    text += ".0";
  }
  return text;
}

double shortest_double(float value) {
  std::array<char, 40> buffer{};
  const auto [end, failure] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  double result = 0.0;
  std::from_chars(buffer.data(), end, result);
  return result;
}

std::string list_text(std::span<const std::string_view> words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    out += i == 0 ? "" : (i + 1 == words.size() ? " or " : ", ");
    out.append("\"").append(words[i]).append("\"");
  }
  return out;
}

std::string list_text(const std::vector<std::string>& words) {
  const std::vector<std::string_view> views(words.begin(), words.end());
  return list_text(std::span<const std::string_view>(views));
}

std::string toml_text(const ConfigValue& value) { return std::visit(TomlText{}, value); }

}  // namespace hulltrack
