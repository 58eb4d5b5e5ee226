#include "core/map/level_cells.hpp"

#include <cmath>

#include "core/geometry/box.hpp"

namespace hulltrack {

LevelCells::LevelCells(std::span<const Point> cloud_H) {
  const Box box = bounding_box(cloud_H);
  corner_ = box.min;
  const Cell last = cell_of(box.max);
  columns_ = last.column + 1;
  rows_ = last.row + 1;
  make_tiles(cloud_H);
}

int LevelCells::cells(float metres) { return static_cast<int>(std::lround(metres / kCell)); }

/// Clamped to a million cells, far outside of any map, so that sums with cell numbers cannot overflow.
LevelCells::Cell LevelCells::cell_of(const Point& p) const {
  const auto cell = [](float v) { return static_cast<int>(std::floor(std::clamp(v, -1e6F, 1e6F))); };
  return {cell((p.x() - corner_.x()) / kCell), cell((p.y() - corner_.y()) / kCell)};
}

/// Stores a tile if a point lies in it or in a cell beside it: callers also ask at the mean of a few points,
/// which may lie in the next cell. Stores an empty tile if tiles with points lie within kFarTiles on all
/// four sides: the floor of a hold that no survey saw. There are at most five of these for each tile with
/// points.
void LevelCells::make_tiles(std::span<const Point> cloud_H) {
  BlockIndex with_points;
  std::vector<Cell> tiles;
  BlockIndex kept;
  const auto keep = [&](int column, int row) {
    if (kept.add(column, row, 0) == tiles.size()) {
      tiles.push_back({column, row});
    }
  };
  for (const Point& p : cloud_H) {
    const Cell c = cell_of(p);
    with_points.add(c.column >> kTileBits, c.row >> kTileBits, 0);
    for (const int row : {c.row - 1, c.row + 1}) {
      for (const int column : {c.column - 1, c.column + 1}) {
        keep(column >> kTileBits, row >> kTileBits);
      }
    }
  }
  const auto any = [&](Cell tile, int dc, int dr) {
    for (int i = 1; i <= kFarTiles; ++i) {
      if (with_points.find(tile.column + i * dc, tile.row + i * dr, 0) != BlockIndex::kNone) {
        return true;
      }
    }
    return false;
  };
  for (std::size_t i = 0, all = tiles.size(); i < all; ++i) {
    Cell tile = tiles[i];
    if (with_points.find(tile.column, tile.row, 0) == BlockIndex::kNone) {
      continue;
    }
    for (int step = 1; step <= kFarTiles; ++step) {
      ++tile.column;
      if (with_points.find(tile.column, tile.row, 0) != BlockIndex::kNone) {
        break;
      }
      if (any(tile, 1, 0) && any(tile, 0, 1) && any(tile, 0, -1)) {
        keep(tile.column, tile.row);
      }
    }
  }
  std::sort(tiles.begin(), tiles.end(),
            [](Cell a, Cell b) { return std::pair(a.row, a.column) < std::pair(b.row, b.column); });
  for (const Cell& tile : tiles) {
    tiles_.add(tile.column, tile.row, 0);
    corners_.push_back({tile.column * kTile, tile.row * kTile});
  }
}

}  // namespace hulltrack
