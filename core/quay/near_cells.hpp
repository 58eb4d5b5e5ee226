// Is anything of a map near this place? For who asks often, of returns that may lie elsewhere than they seem
// to.
//
// Cells of 0.2 m, kept where there is something: a cell is near if a point lies in it or in a cell that
// shares a face or an edge with it: as a rule within 0.3 m, never beyond 0.6 m. Metres. Precondition: finite
// points. Immutable; any number of threads may ask. No failure: what lies farther than 100 km from the origin
// is near nothing. Cost: some 30 ns to ask; a dense cloud takes some bytes a point, a point that stands alone
// hundreds.
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
    /// And so is what lies a metre off to all four sides on the level: inside a large level surface.
    bool inside_level = false;
  };
  [[nodiscard]] Answer at(const Point& p) const;
  /// Whether there is anything straight above or beneath: nothing is known of where the map does not reach.
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
  BlockIndex columns_;             // of blocks
  std::vector<Block> blocks_{{}};  // an empty one, then those of the index
};

}  // namespace hulltrack
