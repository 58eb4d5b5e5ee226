// Which classes of surface have a plane within reach of this place? A fast filter before the search tree is
// asked for the nearest plane.
//
// Space is cut into cells of 0.6 m. Each cell has a bit for each class (surfel.hpp), which is set if a plane
// of the class reaches any point of the cell. So a place may have a bit too many, by up to a cell's size, but
// never one too few. Metres. No failure: far from all planes no bit is set. Thread rule: any number of
// threads may ask. Cost: 10 ns to ask, 3 us a plane to build. Memory: some 300 bytes for a plane that stands
// alone, 20 where many are close together.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/block_index.hpp"
#include "core/geometry/cloud.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

class SurfaceCells {
 public:
  static constexpr float kCell = 0.6F;  // m
  using Classes = std::uint8_t;         // bit i: SurfaceClass i

  /// Adds a plane. It reaches a point that is no farther than `along` (m) off it along its unit normal, to
  /// either side, and no farther than `beside` (m) from its middle across the normal.
  void add(const Point& middle, const Point& normal, float along, float beside, SurfaceClass surface);

  /// Classes with a plane that may reach p.
  [[nodiscard]] Classes at(const Point& p) const;

 private:
  static constexpr int kBits = 2;  // blocks of 4 x 4 x 4 cells
  static constexpr std::size_t kCells = std::size_t{1} << (3 * kBits);
  [[nodiscard]] static std::size_t in_block(int x, int y, int z);

  BlockIndex index_;
  std::vector<std::array<Classes, kCells>> blocks_{{}};  // an empty block first, then those of index_
};

}  // namespace hulltrack
