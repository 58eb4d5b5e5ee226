// A number as a field of a table: the shortest text that reads back equal, and a comma.
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

}  // namespace hulltrack
