// Values as text: numbers and strings in TOML's notation, lists of words for messages.
//
// A double is written as the shortest text that reads back equal.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/key_table.hpp"

namespace hulltrack {

/// "20.0", "-0.5", "1e-09": always a TOML float.
[[nodiscard]] std::string number_text(double value);
/// The double that a person means who writes this float: 0.1 for 0.1F.
[[nodiscard]] double shortest_double(float value);
/// `a`, `b` or `c`.
[[nodiscard]] std::string list_text(std::span<const std::string_view> words);
[[nodiscard]] std::string list_text(const std::vector<std::string>& words);
/// The value as TOML.
[[nodiscard]] std::string toml_text(const ConfigValue& value);

}  // namespace hulltrack
