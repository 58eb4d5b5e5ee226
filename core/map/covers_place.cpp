#include "core/map/covers_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/map/horizons.hpp"

namespace hulltrack {
namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr float kNoRim = std::numeric_limits<float>::quiet_NaN();
// What stands higher than a rim by less than this still belongs to the rim: sheer, rest bars and noise.
constexpr float kOnRim = 0.15F;  // m

}  // namespace

std::vector<float> find_covers_place(
    const LevelCells& cells, const std::vector<float>& rims,
    const std::function<bool(LevelCells::Cell, LevelCells::Cell)>& any_hold) {
  std::vector<float> covers_from(cells.size(), kNowhere);
  // One more: cells inside a hold begin one cell off its edge.
  const int reach = LevelCells::cells(kCoversReach) + 1;
  LevelCells::Window<float> window(kNoRim);
  std::vector<float> along_rows;
  for (std::size_t tile = 0; tile < cells.corners().size(); ++tile) {
    const LevelCells::Cell corner = cells.corners()[tile];
    if (!any_hold(
            {corner.column - reach, corner.row - reach},
            {corner.column + LevelCells::kTile - 1 + reach, corner.row + LevelCells::kTile - 1 + reach})) {
      continue;
    }
    cells.copy_around(rims, tile, 1, window);
    along_rows.assign(static_cast<std::size_t>((LevelCells::kTile + 2 * reach) * LevelCells::kTile),
                      kNowhere);
    for (int row = 0; row < LevelCells::kTile + 2 * reach; ++row) {
      for (int column = 0; column < LevelCells::kTile; ++column) {
        float& least = along_rows[static_cast<std::size_t>(row * LevelCells::kTile + column)];
        for (int dc = -reach; dc <= reach; ++dc) {
          const float rim = window.at({corner.column + column + dc, corner.row + row - reach});
          least = std::isnan(rim) ? least : std::min(least, rim + kOnRim);
        }
      }
    }
    for (int row = 0; row < LevelCells::kTile; ++row) {
      for (int column = 0; column < LevelCells::kTile; ++column) {
        float& least = covers_from[tile * LevelCells::kTileCells +
                                   static_cast<std::size_t>(row * LevelCells::kTile + column)];
        for (int i = row; i <= row + 2 * reach; ++i) {
          least = std::min(least, along_rows[static_cast<std::size_t>(i * LevelCells::kTile + column)]);
        }
      }
    }
  }
  return covers_from;
}

std::vector<std::uint8_t> find_tall_columns(const LevelCells& cells, const std::vector<float>& top,
                                            const std::vector<float>& covers_from) {
  std::vector<std::uint8_t> tall(cells.size(), 0);
  cells.for_each_cell([&](LevelCells::Cell c, std::size_t place) {
    if (top[place] <= covers_from[place]) {
      return;
    }
    tall[place] = 1;
    for (const auto& [dc, dr] : kDirections) {
      const std::size_t beside = cells.place_of({c.column + dc, c.row + dr});
      if (beside != LevelCells::kNoPlace && covers_from[beside] != kNowhere) {
        tall[beside] = 1;
      }
    }
  });
  return tall;
}

}  // namespace hulltrack
