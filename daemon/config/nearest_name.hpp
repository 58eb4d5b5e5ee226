// Which of the known names did a person mean who wrote this one?
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hulltrack {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment distance).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The nearest of `names` if it is near enough to be meant: at most a third of its letters differ.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view written,
                                                      const std::vector<std::string>& names);

}  // namespace hulltrack
