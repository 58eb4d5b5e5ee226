// Which cells of space does the mapped hull occupy, and how many points of a cloud would lie in them if the
// cloud were shifted by whole cells?
//
// Cells of kCell in H: worth 2 with a point of the map in it, 1 beside such a cell (a shift is off by up to
// half a cell, a hull by its turn). Height is the fastest index, so that one look at a column of cells
// answers for all vertical shifts at once. Kept in blocks of kSide x kSide columns, only where the map is.
// Frame H, metres, within 100 km of the origin. Immutable. No failure: points outside count nothing.
// Cost: 2 to 6 MB a ship, and for scattered points 20 kB each; correlate() some 6 ns a point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/block_index.hpp"
#include "core/geometry/cloud.hpp"

namespace hulltrack {

class OccupancyGrid {
 public:
  static constexpr float kCell = 0.5F;  // m
  /// Vertical shifts by -kUp .. kUp cells are answered together: 15 m up and down.
  static constexpr int kUp = 30;
  static constexpr int kHeights = 2 * kUp + 1;

  explicit OccupancyGrid(std::span<const Point> occupied_H);

  struct Index {
    int x, y, z;
  };
  [[nodiscard]] Index cell_of(const Point& p_H) const;

  /// worth[kUp + k] is increased by what `cells` are worth if each is shifted by (x, y, k) cells.
  void correlate(std::span<const Index> cells, int x, int y, std::span<std::uint16_t, kHeights> worth) const;

  /// Heap memory that the grid holds, bytes.
  [[nodiscard]] std::size_t memory() const { return worth_.capacity() + blocks_.memory(); }

 private:
  void mark(const Index& cell, std::uint8_t worth);
  void mark_in_layer(const Index& cell, int layer, int height, std::uint8_t worth);

  Point origin_H_;
  Index low_{}, high_{};  // of the cells that are worth something
  BlockIndex blocks_;
  std::vector<std::uint8_t> worth_;  // block by block: x, y, height in the layer
};

}  // namespace hulltrack
