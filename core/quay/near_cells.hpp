// Is any point of a map near this place? A fast yes or no without distances, for many places.
//
// Space is cut into cells of 0.2 m, with bits for each. A cell is near if a point of the map lies in it, or
// in a cell that shares a face or an edge with it. So a place that is near has a point within 0.3 m as a
// rule, and always within 0.6 m. Metres. Precondition: finite points. Immutable; any number of threads may
// ask. No failure: a place farther than 100 km from the origin is near nothing. Cost: some 30 ns to ask.
// Memory: some bytes a point of a dense cloud, hundreds for a point that stands alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/block_index.hpp"
#include "core/geometry/cloud.hpp"

namespace hulltrack {

class NearCells {
 public:
  static constexpr float kCell = 0.2F;  // m

  explicit NearCells(std::span<const Point> points);

  struct Answer {
    bool near = false;
    /// The cell is near, and so are the cells 1 m away along +-X and +-Y at the same height: the place is
    /// inside a large level surface.
    bool inside_level = false;
  };
  [[nodiscard]] Answer at(const Point& p) const;
  /// Whether the map has a point in the same column of 0.8 m x 0.8 m, at any height. Nothing is known of
  /// places where it has none.
  [[nodiscard]] bool in_reach(const Point& p) const;

 private:
  struct Cell {
    int x, y, z;
  };
  struct Block {  // of 4 x 4 x 4 cells, a bit for each
    std::uint64_t near = 0;
    std::uint64_t level = 0;
  };
  [[nodiscard]] static bool is_far(const Point& p);
  [[nodiscard]] static Cell cell_of(const Point& p);
  [[nodiscard]] static std::uint64_t bit_of(const Cell& cell);
  [[nodiscard]] const Block& block_of(const Cell& cell) const;
  [[nodiscard]] bool near(const Cell& cell) const;
  void mark(const Cell& cell, std::vector<Cell>& blocks);
  void mark_level(const Cell& block);

  BlockIndex index_;
  BlockIndex columns_;             // columns of blocks in which the map has a point
  std::vector<Block> blocks_{{}};  // an empty block first, then those of index_
};

}  // namespace hulltrack
