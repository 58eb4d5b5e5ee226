#include "core/map/stray_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/filter/voxel_filter.hpp"
#include "core/geometry/block_index.hpp"
#include "core/geometry/box.hpp"

namespace hulltrack {
namespace {

// Surface is counted in occupied voxels of this size, so that ten thousand equal points count once.
constexpr double kSurfaceVoxel = 0.4;  // m

using Cell = std::array<int, 3>;

Cell cell_of(const Point& p) {
  const auto cell = [](float v) { return static_cast<int>(std::floor(v / kStrayApart)); };
  return {cell(p.x()), cell(p.y()), cell(p.z())};
}

/// The pieces of a cloud: occupied cells that share a face, an edge or a corner are of one piece.
class Pieces {
 public:
  explicit Pieces(const Cloud& cloud) {
    for (const Point& p : cloud) {
      const Cell c = cell_of(p);
      if (index_.add(c[0], c[1], c[2]) == cells_.size()) {
        cells_.push_back(c);
      }
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    piece_.assign(cells_.size(), kNone);
    std::vector<std::uint32_t> grown;
    for (std::uint32_t first = 0; first < cells_.size(); ++first) {
      if (piece_[first] != kNone) {
        continue;
      }
      const auto number = static_cast<std::uint32_t>(count_++);
      piece_[first] = number;
      grown.push_back(first);
      while (!grown.empty()) {
        const Cell from = cells_[grown.back()];
        grown.pop_back();
        for (int i = 0; i < 27; ++i) {
          const std::uint32_t beside =
              index_.find(from[0] + i % 3 - 1, from[1] + i / 3 % 3 - 1, from[2] + i / 9 - 1);
          if (beside != BlockIndex::kNone && piece_[beside] == kNone) {
            piece_[beside] = number;
            grown.push_back(beside);
          }
        }
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::uint32_t of(const Point& p) const {
    const Cell c = cell_of(p);
    return piece_[index_.find(c[0], c[1], c[2])];
  }

 private:
  BlockIndex index_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> piece_;  // per cell
  std::size_t count_ = 0;
};

double distance(const Box& box, const Point& p) {
  return static_cast<double>((p - p.cwiseMax(box.min).cwiseMin(box.max)).norm());
}

}  // namespace

StrayPoints take_out_strays(Cloud& cloud) {
  StrayPoints strays;
  const Pieces pieces(cloud);
  if (pieces.count() < 2) {
    return strays;
  }
  std::vector<std::size_t> surface(pieces.count(), 0);
  VoxelFilter voxels(kSurfaceVoxel);
  const auto places = voxels.select(cloud);
  for (const std::uint32_t i : places) {
    ++surface[pieces.of(cloud[i])];
  }
  const auto ship =
      static_cast<std::uint32_t>(std::max_element(surface.begin(), surface.end()) - surface.begin());
  if (static_cast<double>(places.size() - surface[ship]) > kStrayShare * static_cast<double>(places.size())) {
    return strays;
  }
  Cloud kept;
  Cloud left_out;
  for (const Point& p : cloud) {
    (pieces.of(p) == ship ? kept : left_out).push_back(p);
  }
  const Box box = bounding_box(kept);
  strays = {left_out.size(), std::numeric_limits<double>::infinity(), 0.0};
  for (const Point& p : left_out) {
    strays.nearest = std::min(strays.nearest, distance(box, p));
    strays.farthest = std::max(strays.farthest, distance(box, p));
  }
  cloud = std::move(kept);
  return strays;
}

}  // namespace hulltrack
