#include "core/map/occupancy_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/box.hpp"

namespace hulltrack {
namespace {

// Heights are summed by whole registers, and in bytes as long as these hold what so many cells are worth.
constexpr int kLanes = 64;
constexpr std::size_t kCellsInBytes = 127;  // of 2 at most
static_assert(kLanes >= OccupancyGrid::kHeights);

// A block: columns of one layer, and above each what a look that begins in the layer sees of the next.
constexpr int kSideBits = 2;
constexpr int kSide = 1 << kSideBits;
constexpr int kLayerBits = 8;
constexpr int kLayer = 1 << kLayerBits;
constexpr int kColumn = kLayer + kLanes;
constexpr std::size_t kBlock = std::size_t{kSide} * kSide * kColumn;

// Heights are counted from so far below the lowest cell that all looks at a hull begin in one layer.
constexpr int kBelow = 2 * OccupancyGrid::kUp;

/// Of a column's height 0 in its block.
std::size_t column_of(int x, int y) {
  return static_cast<std::size_t>((x & (kSide - 1)) * kSide + (y & (kSide - 1))) * kColumn;
}

}  // namespace

OccupancyGrid::OccupancyGrid(std::span<const Point> occupied_H) {
  const Box box = bounding_box(occupied_H);
  origin_H_ = box.min - Point::Constant(kCell);
  // Which cell a point lies in is for cell_of() alone to say: it rounds.
  low_ = cell_of(box.min);
  high_ = cell_of(box.max);
  low_ = {low_.x - 1, low_.y - 1, low_.z - 1};
  high_ = {high_.x + 1, high_.y + 1, high_.z + 1};
  constexpr Index kBeside[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  for (const Point& p : occupied_H) {
    const Index cell = cell_of(p);
    mark(cell, 2);
    for (const Index& d : kBeside) {
      mark({cell.x + d.x, cell.y + d.y, cell.z + d.z}, 1);
    }
  }
}

OccupancyGrid::Index OccupancyGrid::cell_of(const Point& p_H) const {
  const Point scaled = (p_H - origin_H_) / kCell;
  // Far outside is outside: whole numbers stay small enough to be shifted.
  const auto cell = [](float v) { return static_cast<int>(std::floor(std::clamp(v, -1e6F, 1e6F))); };
  return {cell(scaled.x()), cell(scaled.y()), cell(scaled.z())};
}

void OccupancyGrid::mark(const Index& cell, std::uint8_t worth) {
  const int z = cell.z + kBelow;
  const int layer = z >> kLayerBits;
  const int height = z & (kLayer - 1);
  mark_in_layer(cell, layer, height, worth);
  if (height < kHeights - 1) {
    mark_in_layer(cell, layer - 1, kLayer + height, worth);
  }
}

void OccupancyGrid::mark_in_layer(const Index& cell, int layer, int height, std::uint8_t worth) {
  const std::uint32_t block = blocks_.add(cell.x >> kSideBits, cell.y >> kSideBits, layer);
  worth_.resize(blocks_.size() * kBlock, 0);
  std::uint8_t& at = worth_[block * kBlock + column_of(cell.x, cell.y) + static_cast<std::size_t>(height)];
  at = std::max(at, worth);
}

void OccupancyGrid::correlate(std::span<const Index> cells, int x, int y,
                              std::span<std::uint16_t, kHeights> worth) const {
  std::array<std::uint8_t, kLanes> bytes{};
  std::size_t cells_in_bytes = 0;
  const auto empty_bytes = [&] {
    for (std::size_t k = 0; k < kHeights; ++k) {
      worth[k] = static_cast<std::uint16_t>(worth[k] + bytes[k]);
    }
    bytes.fill(0);
    cells_in_bytes = 0;
  };
  for (const Index& cell : cells) {
    const int cx = cell.x + x;
    const int cy = cell.y + y;
    if (cx < low_.x || cx > high_.x || cy < low_.y || cy > high_.y) {
      continue;
    }
    const int lowest = cell.z - kUp + kBelow;
    const std::uint32_t block = blocks_.find(cx >> kSideBits, cy >> kSideBits, lowest >> kLayerBits);
    if (block == BlockIndex::kNone) {
      continue;
    }
    const std::uint8_t* column =
        &worth_[block * kBlock + column_of(cx, cy) + static_cast<std::size_t>(lowest & (kLayer - 1))];
    // The lanes beyond kHeights may lack the next layer's: nobody asks for them.
    for (std::size_t k = 0; k < kLanes; ++k) {
      bytes[k] = static_cast<std::uint8_t>(bytes[k] + column[k]);
    }
    if (++cells_in_bytes == kCellsInBytes) {
      empty_bytes();
    }
  }
  empty_bytes();
}

}  // namespace hulltrack
