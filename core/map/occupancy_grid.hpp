// Which cells of space does the mapped hull occupy, and how many points of a cloud would lie in them if the
// cloud were shifted by whole cells?
//
// Cells of kCell in H: worth 2 with a plane of the map in it, 1 beside such a cell (a shift is off by up to
// half a cell, a hull by its turn). Height is the fastest index, so that one look at a column of cells
// answers for all vertical shifts at once. Frame H, metres. Immutable. No failure: points outside count
// nothing. Cost: 1 to 3 MB a ship; correlate() some 6 ns a point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

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

 private:
  [[nodiscard]] std::uint8_t& at(const Index& i);
  void mark(const Index& cell);

  Point origin_H_;
  Index size_{};
  std::vector<std::uint8_t> worth_;  // x, y, z; kUp empty cells above and below
};

}  // namespace hulltrack
