// Text to numbers, whole words only: the readers of this folder agree here on what a number is.
//
// Independent of the locale; allocates nothing. Thread rule: pure functions.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace hulltrack {

/// The whole field as a number of type T; nothing for rubbish, overflow, NaN or infinity.
template <typename T>
[[nodiscard]] std::optional<T> parse_number(std::string_view field) {
  T value{};
  const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (failure != std::errc{} || end != field.data() + field.size()) {
    return std::nullopt;
  }
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) {
      return std::nullopt;
    }
  }
  return value;
}

/// A coordinate in text; "nan" and "inf" are numbers here. False for anything else.
[[nodiscard]] inline bool parse_coordinate(std::string_view word, double& value) {
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  return failure == std::errc{} && end == word.data() + word.size();
}

}  // namespace hulltrack
