// The level cells of a map seen from above, stored only where the map has points.
//
// Cells are squares of kCell. They are stored in tiles of kTile x kTile, where the map has points in or
// beside the tile, or on all four sides of it. Values of cells live with those who compute them, as vectors
// in the order of place_of(). Input in frame H, metres, within 100 km of the origin. Immutable. Cannot fail.
// Cost: a point adds at most nine tiles, however the points are scattered.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/block_index.hpp"
#include "core/geometry/cloud.hpp"

namespace hulltrack {

class LevelCells {
 public:
  static constexpr float kCell = 0.25F;  // m
  static constexpr int kTileBits = 4;
  static constexpr int kTile = 1 << kTileBits;  // cells
  static constexpr std::size_t kTileCells = std::size_t{kTile} * kTile;
  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);
  /// An empty tile is stored if there are points within this many tiles on all four sides of it.
  static constexpr int kFarTiles = 5;

  struct Cell {
    int column, row;
  };
  /// The values of a tile and of the tiles around it, copied into one rectangle of cells.
  template <typename T>
  struct Window {
    explicit Window(T value_of_nothing) : nothing(value_of_nothing) {}

    [[nodiscard]] bool holds(Cell c) const {
      return c.column >= first.column && c.column < first.column + columns && c.row >= first.row &&
             c.row < first.row + rows;
    }
    [[nodiscard]] const T& of(Cell c) const {
      return values[static_cast<std::size_t>((c.row - first.row) * columns + c.column - first.column)];
    }
    [[nodiscard]] T at(Cell c) const { return holds(c) ? of(c) : nothing; }

    T nothing;
    Cell first{};
    int columns = 0;
    int rows = 0;
    std::vector<T> values;
  };

  explicit LevelCells(std::span<const Point> cloud_H);

  /// Stored cells, also those outside of the map's rectangle.
  [[nodiscard]] std::size_t size() const { return corners_.size() * kTileCells; }
  /// Per tile: its first cell; row by row.
  [[nodiscard]] std::span<const Cell> corners() const { return corners_; }
  /// Number of the stored tile, by the column and row of tiles; BlockIndex::kNone if it is not stored.
  [[nodiscard]] std::uint32_t tile(int column, int row) const { return tiles_.find(column, row, 0); }

  [[nodiscard]] Cell cell_of(const Point& p) const;
  /// The middle of a cell, at height z.
  [[nodiscard]] Point middle_of(Cell c, float z) const {
    return {corner_.x() + (static_cast<float>(c.column) + 0.5F) * kCell,
            corner_.y() + (static_cast<float>(c.row) + 0.5F) * kCell, z};
  }
  /// How many cells such a length is.
  [[nodiscard]] static int cells(float metres);
  [[nodiscard]] bool inside(Cell c) const {
    return c.column >= 0 && c.column < columns_ && c.row >= 0 && c.row < rows_;
  }
  /// Index of the cell in vectors of values; kNoPlace for a cell whose tile is not stored.
  [[nodiscard]] std::size_t place_of(Cell c) const {
    const std::uint32_t number =
        inside(c) ? tile(c.column >> kTileBits, c.row >> kTileBits) : BlockIndex::kNone;
    return number == BlockIndex::kNone ? kNoPlace : number * kTileCells + in_tile(c);
  }
  [[nodiscard]] static std::size_t in_tile(Cell c) {
    return static_cast<std::size_t>((c.row & (kTile - 1)) * kTile + (c.column & (kTile - 1)));
  }
  template <typename T>
  [[nodiscard]] T at(const std::vector<T>& values, Cell c, T nothing) const {
    const std::size_t place = place_of(c);
    return place == kNoPlace ? nothing : values[place];
  }

  /// Calls visit(cell, place_of(cell)) for all stored cells inside the map's rectangle, row by row.
  template <typename Visit>
  void for_each_cell(Visit&& visit) const;

  /// Copies `values` of the stored tiles up to `reach` tiles from `tile` into the window, so that loops need
  /// no look-up for each cell. Cells of tiles that are not stored get the window's `nothing`.
  template <typename T>
  void copy_around(const std::vector<T>& values, std::size_t tile, int reach, Window<T>& window) const;

  /// Heap memory that this holds, bytes.
  [[nodiscard]] std::size_t memory() const { return corners_.capacity() * sizeof(Cell) + tiles_.memory(); }

 private:
  void make_tiles(std::span<const Point> cloud_H);

  Point corner_ = Point::Zero();
  int columns_ = 0;  // of the map's bounding rectangle
  int rows_ = 0;
  BlockIndex tiles_;
  std::vector<Cell> corners_;
};

template <typename Visit>
void LevelCells::for_each_cell(Visit&& visit) const {
  for (std::size_t begin = 0, end = 0; begin < corners_.size(); begin = end) {
    while (end < corners_.size() && corners_[end].row == corners_[begin].row) {
      ++end;
    }
    for (int row = 0; row < kTile; ++row) {
      for (std::size_t tile = begin; tile < end; ++tile) {
        for (int column = 0; column < kTile; ++column) {
          const Cell c{corners_[tile].column + column, corners_[tile].row + row};
          if (inside(c)) {
            visit(c, tile * kTileCells + in_tile(c));
          }
        }
      }
    }
  }
}

template <typename T>
void LevelCells::copy_around(const std::vector<T>& values, std::size_t tile, int reach,
                             Window<T>& window) const {
  const Cell middle{corners_[tile].column >> kTileBits, corners_[tile].row >> kTileBits};
  Cell low = middle;
  Cell high = middle;
  std::vector<std::pair<Cell, std::uint32_t>> near;
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      if (const std::uint32_t number = this->tile(column, row); number != BlockIndex::kNone) {
        near.push_back({{column, row}, number});
        low = {std::min(low.column, column), std::min(low.row, row)};
        high = {std::max(high.column, column), std::max(high.row, row)};
      }
    }
  }
  window.first = {low.column * kTile, low.row * kTile};
  window.columns = (high.column - low.column + 1) * kTile;
  window.rows = (high.row - low.row + 1) * kTile;
  window.values.assign(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows),
                       window.nothing);
  for (const auto& [place, number] : near) {
    for (int row = 0; row < kTile; ++row) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(number * kTileCells) + row * kTile;
      std::copy_n(from, kTile,
                  window.values.begin() + ((place.row - low.row) * kTile + row) * window.columns +
                      (place.column - low.column) * kTile);
    }
  }
}

}  // namespace hulltrack
