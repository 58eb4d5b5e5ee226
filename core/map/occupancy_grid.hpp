// Which cells of space does the mapped hull occupy, and how well would a cloud, shifted by whole cells, match
// them?
//
// Cells are cubes of kCell in H. A cell with a point of the map has the value 2, a cell that shares a face
// with one of these 1: a shift by whole cells is off by up to half a cell, and the hull may be turned a
// little. The match of a shift is a sum over the cloud's points: the values of the cells in which they then
// lie. Height is the fastest index, so that one read of a column of cells answers for all vertical shifts.
// Stored in blocks of columns, only where the map is.
// Frame H, metres, within 100 km of the origin. Immutable. Cannot fail: cells outside have the value 0.
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
  /// Vertical shifts by -kUp to kUp cells are answered together: 15 m up and down.
  static constexpr int kUp = 30;
  static constexpr int kHeights = 2 * kUp + 1;

  explicit OccupancyGrid(std::span<const Point> occupied_H);

  struct Index {
    int x, y, z;
  };
  [[nodiscard]] Index cell_of(const Point& p_H) const;

  /// For each k from -kUp to kUp: shifts every one of `cells` by (x, y, k) cells and adds what the cells
  /// reached add up to values[kUp + k].
  void correlate(std::span<const Index> cells, int x, int y, std::span<std::uint16_t, kHeights> values) const;

  /// Heap memory that the grid holds, bytes.
  [[nodiscard]] std::size_t memory() const { return worth_.capacity() + blocks_.memory(); }

 private:
  void mark(const Index& cell, std::uint8_t value);
  void mark_in_layer(const Index& cell, int layer, int height, std::uint8_t value);

  Point origin_H_;
  Index low_{}, high_{};  // bounds of the cells that have a value
  BlockIndex blocks_;
  std::vector<std::uint8_t> worth_;  // block by block: x, y, height in the layer
};

}  // namespace hulltrack
