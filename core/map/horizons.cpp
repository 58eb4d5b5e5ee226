#include "core/map/horizons.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace hulltrack {
namespace {

using Cell = LevelCells::Cell;

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr float kNowhere = std::numeric_limits<float>::infinity();

// The horizon of a cell depends on the tiles that LevelCells keeps around it.
static_assert(kHorizonReach / LevelCells::kCell / LevelCells::kTile == float{LevelCells::kFarTiles});

/// Per tile: 1 if it has no point and one of its four sides has none within kHorizonReach. Its cells then
/// have no horizon.
std::vector<std::uint8_t> open_tiles(const LevelCells& cells, std::span<const float> top) {
  const std::span<const Cell> corners = cells.corners();
  std::vector<std::uint8_t> bare(corners.size());
  for (std::size_t tile = 0; tile < corners.size(); ++tile) {
    const auto first = top.begin() + static_cast<std::ptrdiff_t>(tile * LevelCells::kTileCells);
    bare[tile] =
        std::all_of(first, first + LevelCells::kTileCells, [](float height) { return height == kNothing; })
            ? 1
            : 0;
  }
  const auto nothing = [&](std::size_t from, int dc, int dr) {
    for (int i = 0; i <= LevelCells::kFarTiles; ++i) {
      const std::uint32_t tile = cells.tile((corners[from].column >> LevelCells::kTileBits) + i * dc,
                                            (corners[from].row >> LevelCells::kTileBits) + i * dr);
      if (tile != BlockIndex::kNone && bare[tile] == 0) {
        return false;
      }
    }
    return true;
  };
  std::vector<std::uint8_t> open(corners.size());
  for (std::size_t tile = 0; tile < corners.size(); ++tile) {
    const bool is_open =
        nothing(tile, 1, 0) || nothing(tile, -1, 0) || nothing(tile, 0, 1) || nothing(tile, 0, -1);
    open[tile] = is_open ? 1 : 0;
  }
  return open;
}

}  // namespace

std::vector<float> find_horizons(const LevelCells& cells, const std::vector<float>& top) {
  const std::span<const Cell> corners = cells.corners();
  std::vector<float> horizons(top.size(), kNothing);
  LevelCells::Window<float> around(kNothing);
  // Lowers the horizons of a line of the tile's cells to what they see along it; kNothing without a point
  // within kHorizonReach. The line has n cells inside of the tile. Cell i of it sees the cells behind it in
  // the tile, all cells from n to `steps` after the line's first, which every cell of the line sees, and i
  // cells more.
  const auto lower_along = [&](std::size_t tile, Cell first, int dc, int dr) {
    const auto inside = [](int v) { return v >= 0 && v < LevelCells::kTile; };
    const auto seen = [&](int i) {
      return around.at(
          {corners[tile].column + first.column + i * dc, corners[tile].row + first.row + i * dr});
    };
    const float stride = dc != 0 && dr != 0 ? std::sqrt(2.0F) * LevelCells::kCell : LevelCells::kCell;
    const int steps = static_cast<int>(kHorizonReach / stride);
    int n = 1;
    while (inside(first.column + n * dc) && inside(first.row + n * dr)) {
      ++n;
    }
    const auto horizon = [&](int i) -> float& {
      return horizons[tile * LevelCells::kTileCells +
                      LevelCells::in_tile({first.column + i * dc, first.row + i * dr})];
    };
    bool any = false;
    for (int i = 0; i < n; ++i) {
      any = any || horizon(i) != kNothing;
    }
    if (!any) {
      return;
    }
    float common = kNothing;
    for (int i = n; i <= steps; ++i) {
      common = std::max(common, seen(i));
    }
    std::array<float, LevelCells::kTile> behind;
    behind[static_cast<std::size_t>(n - 1)] = kNothing;
    for (int i = n - 1; i > 0; --i) {
      behind[static_cast<std::size_t>(i - 1)] = std::max(behind[static_cast<std::size_t>(i)], seen(i));
    }
    float more = kNothing;
    for (int i = 0; i < n; ++i) {
      more = i > 0 ? std::max(more, seen(steps + i)) : more;
      horizon(i) = std::min(horizon(i), std::max({common, behind[static_cast<std::size_t>(i)], more}));
    }
  };
  const std::vector<std::uint8_t> open = open_tiles(cells, top);
  for (std::size_t tile = 0; tile < corners.size(); ++tile) {
    if (open[tile] != 0) {
      continue;
    }
    cells.copy_around(top, tile, LevelCells::kFarTiles, around);
    std::fill_n(horizons.begin() + static_cast<std::ptrdiff_t>(tile * LevelCells::kTileCells),
                LevelCells::kTileCells, kNowhere);
    for (const auto& [dc, dr] : kDirections) {
      for (int i = 0; i < LevelCells::kTile; ++i) {
        // Lines begin at the tile's edge that looks against the direction, a diagonal one's at two edges.
        const int edge_column = dc > 0 ? 0 : LevelCells::kTile - 1;
        const int edge_row = dr > 0 ? 0 : LevelCells::kTile - 1;
        if (dc != 0) {
          lower_along(tile, {edge_column, i}, dc, dr);
        }
        if (dr != 0 && (dc == 0 || i != edge_column)) {
          lower_along(tile, {i, edge_row}, dc, dr);
        }
      }
    }
  }
  return horizons;
}

}  // namespace hulltrack
