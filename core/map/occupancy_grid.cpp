#include "core/map/occupancy_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/box.hpp"

namespace hulltrack {
namespace {

// correlate() adds 64 heights at once as bytes, whole registers; only the first kHeights of them are wanted.
// A cell has a value of 2 at most, so that a byte holds the sum of 127 cells. Then 16 bits take over.
constexpr int kLanes = 64;
constexpr std::size_t kCellsInBytes = 127;
static_assert(kLanes >= OccupancyGrid::kHeights);

// A layer is 256 heights. A block holds 4 x 4 columns of one layer, each followed by a copy of the lowest
// heights of the next layer, so that a read that begins in the layer needs no second block.
constexpr int kSideBits = 2;
constexpr int kSide = 1 << kSideBits;
constexpr int kLayerBits = 8;
constexpr int kLayer = 1 << kLayerBits;
constexpr int kColumn = kLayer + kLanes;
constexpr std::size_t kBlock = std::size_t{kSide} * kSide * kColumn;

// Heights count from this many cells below the lowest cell, so that all reads for a hull begin in one layer.
constexpr int kBelow = 2 * OccupancyGrid::kUp;

/// Index of the column's height 0 within its block.
std::size_t column_of(int x, int y) {
  return static_cast<std::size_t>((x & (kSide - 1)) * kSide + (y & (kSide - 1))) * kColumn;
}

}  // namespace

OccupancyGrid::OccupancyGrid(std::span<const Point> occupied_H) {
  const Box box = bounding_box(occupied_H);
  origin_H_ = box.min - Point::Constant(kCell);
  // The bounds come from cell_of(), too, so that its rounding cannot put a point outside of them.
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
  // Clamped far outside of any map, so that shifting the whole numbers cannot overflow.
  const auto cell = [](float v) { return static_cast<int>(std::floor(std::clamp(v, -1e6F, 1e6F))); };
  return {cell(scaled.x()), cell(scaled.y()), cell(scaled.z())};
}

void OccupancyGrid::mark(const Index& cell, std::uint8_t value) {
  const int z = cell.z + kBelow;
  const int layer = z >> kLayerBits;
  const int height = z & (kLayer - 1);
  mark_in_layer(cell, layer, height, value);
  if (height < kHeights - 1) {
    mark_in_layer(cell, layer - 1, kLayer + height, value);
  }
}

void OccupancyGrid::mark_in_layer(const Index& cell, int layer, int height, std::uint8_t value) {
  const std::uint32_t block = blocks_.add(cell.x >> kSideBits, cell.y >> kSideBits, layer);
  worth_.resize(blocks_.size() * kBlock, 0);
  std::uint8_t& at = worth_[block * kBlock + column_of(cell.x, cell.y) + static_cast<std::size_t>(height)];
  at = std::max(at, value);
}

void OccupancyGrid::correlate(std::span<const Index> cells, int x, int y,
                              std::span<std::uint16_t, kHeights> values) const {
  std::array<std::uint8_t, kLanes> bytes{};
  std::size_t cells_in_bytes = 0;
  const auto empty_bytes = [&] {
    for (std::size_t k = 0; k < kHeights; ++k) {
      values[k] = static_cast<std::uint16_t>(values[k] + bytes[k]);
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
    // The lanes from kHeights on may lack heights of the next layer. They are no part of the answer.
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
