#include "core/map/occupancy_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/box.hpp"

namespace hulltrack {
namespace {

constexpr int kMargin = 1;  // cells around the occupied ones

// Heights are summed by whole registers, and in bytes as long as these hold what so many cells are worth.
constexpr std::size_t kLanes = 64;
constexpr std::size_t kCellsInBytes = 127;  // of 2 at most
static_assert(kLanes >= OccupancyGrid::kHeights);

}  // namespace

OccupancyGrid::OccupancyGrid(std::span<const Point> occupied_H) {
  const Box box = bounding_box(occupied_H);
  origin_H_ = box.min - Point::Constant(kCell * kMargin);
  const auto cells = [&](int axis) {
    return static_cast<int>(std::floor((box.max[axis] - box.min[axis]) / kCell)) + 1 + 2 * kMargin;
  };
  size_ = {cells(0), cells(1), cells(2)};
  worth_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                        static_cast<std::size_t>(size_.z + 4 * kUp) +
                    kLanes - kHeights,
                0);
  for (const Point& p : occupied_H) {
    mark(cell_of(p));
  }
}

OccupancyGrid::Index OccupancyGrid::cell_of(const Point& p_H) const {
  const Point scaled = (p_H - origin_H_) / kCell;
  // Far outside is outside: whole numbers stay small enough to be shifted.
  const auto cell = [](float v) { return static_cast<int>(std::floor(std::clamp(v, -1e6F, 1e6F))); };
  return {cell(scaled.x()), cell(scaled.y()), cell(scaled.z())};
}

// Twice kUp empty cells below and above: a cell kUp outside may be shifted by kUp more.
std::uint8_t& OccupancyGrid::at(const Index& i) {
  const auto column =
      static_cast<std::size_t>(i.x) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(i.y);
  return worth_[column * static_cast<std::size_t>(size_.z + 4 * kUp) +
                static_cast<std::size_t>(i.z + 2 * kUp)];
}

void OccupancyGrid::mark(const Index& cell) {
  at(cell) = 2;
  constexpr Index kBeside[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  for (const Index& d : kBeside) {
    std::uint8_t& beside = at({cell.x + d.x, cell.y + d.y, cell.z + d.z});
    beside = std::max<std::uint8_t>(beside, 1);
  }
}

void OccupancyGrid::correlate(std::span<const Index> cells, int x, int y,
                              std::span<std::uint16_t, kHeights> worth) const {
  const int depth = size_.z + 4 * kUp;
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
    if (cx < 0 || cx >= size_.x || cy < 0 || cy >= size_.y || cell.z < -kUp || cell.z >= size_.z + kUp) {
      continue;
    }
    const std::uint8_t* lowest = &worth_[(static_cast<std::size_t>(cx) * static_cast<std::size_t>(size_.y) +
                                          static_cast<std::size_t>(cy)) *
                                             static_cast<std::size_t>(depth) +
                                         static_cast<std::size_t>(cell.z + kUp)];
    // The lanes beyond kHeights may be of the next column: nobody asks for them.
    for (std::size_t k = 0; k < kLanes; ++k) {
      bytes[k] = static_cast<std::uint8_t>(bytes[k] + lowest[k]);
    }
    if (++cells_in_bytes == kCellsInBytes) {
      empty_bytes();
    }
  }
  empty_bytes();
}

}  // namespace hulltrack
