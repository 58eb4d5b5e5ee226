// A field of a table and a comma: a number as the shortest text that reads back equal, words in quotes.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace hulltrack {

template <typename Number>
void append_field(std::string& line, Number value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  line.append(text.data(), end).push_back(',');
}

/// Quotes within are doubled (RFC 4180) and lines joined, so that a row stays one line. No words, no quotes.
inline void append_words(std::string& line, const std::string& words) {
  if (!words.empty()) {
    line.push_back('"');
    for (const char c : words) {
      line.append(c == '"' ? "\"\"" : std::string(1, c == '\n' ? ' ' : c));
    }
    line.push_back('"');
  }
  line.push_back(',');
}

}  // namespace hulltrack
