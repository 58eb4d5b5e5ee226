// Where do hatch covers stand? Higher than a rim and beside its hold (relief.hpp).
//
// Values of level cells, in the order of LevelCells::place_of(). Frame H, metres. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/map/level_cells.hpp"

namespace hulltrack {

/// Covers that are folded or rolled away stand up to this far from their hatch, m.
inline constexpr float kCoversReach = 3.0F;

/// From which height on each cell is covers' place: the lowest rim within kCoversReach along both axes (the
/// minimum along rows first, then along columns), and a little more. Infinity where there is none. `rims`:
/// height of the rim of cells inside a hold, NaN elsewhere. `any_hold`: whether a tile of the cells from one
/// to the other has a cell inside a hold.
[[nodiscard]] std::vector<float> find_covers_place(
    const LevelCells& cells, const std::vector<float>& rims,
    const std::function<bool(LevelCells::Cell low, LevelCells::Cell high)>& any_hold);

/// 1 for cells whose highest point (`top`) is in the covers' place, and their neighbours: a cover's sides may
/// lean.
[[nodiscard]] std::vector<std::uint8_t> find_tall_columns(const LevelCells& cells,
                                                          const std::vector<float>& top,
                                                          const std::vector<float>& covers_from);

}  // namespace hulltrack
