// How high is the horizon around each cell of a map?
//
// In each of eight level directions the highest point within kHorizonReach counts; the horizon is the lowest
// of these eight heights, m. -infinity where the map has nothing in one of the directions. Frame H. Pure.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "core/map/level_cells.hpp"

namespace hulltrack {

inline constexpr float kHorizonReach = 20.0F;  // m: half of the longest hatch
/// The eight neighbours of a cell: columns and rows.
inline constexpr std::array<std::pair<int, int>, 8> kDirections{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// `top`: height of each cell's highest point, m; -infinity without points.
[[nodiscard]] std::vector<float> find_horizons(const LevelCells& cells, const std::vector<float>& top);

}  // namespace hulltrack
