// A fixed cloud in blocks of neighbouring points, each with a ball around it. Blocks whose ball is out of a
// sensor's range, or in rows that it does not look at, are skipped whole.
//
// Points are ordered along a Z-order curve (z_order.hpp) and cut into blocks of Sightings::kBlock.
// Any frame; metres, float. Immutable. No failure: points that are not finite are left out.
// Cost: some 20 ns a point to build.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"
#include "core/geometry/sighting.hpp"
#include "core/geometry/spherical_grid.hpp"

namespace hulltrack {

/// A part of a sensor's surroundings: up to `range` (m), between two rows of SphericalGrid, both included.
struct SightLimits {
  float range;
  int lowest_row = 0;
  int highest_row = SphericalGrid::kRows - 1;
};

class PointBlocks {
 public:
  explicit PointBlocks(std::span<const Point> cloud);

  /// The points, neighbours together: each Sightings::kBlock of them are a block.
  [[nodiscard]] const Cloud& points() const { return points_; }

  /// Like sight(), but only for blocks that may have a point within the limits: calls visit(sightings, index
  /// therein) for all points of such a block, also those outside of the limits.
  template <typename Visit>
  void sight_within(const SightLimits& limits, const Pose& T_L_A, Visit&& visit) const;

 private:
  [[nodiscard]] std::span<const Point> block(std::size_t b) const {
    const std::size_t first = b * Sightings::kBlock;
    return std::span(points_).subspan(first, std::min(Sightings::kBlock, points_.size() - first));
  }

  struct Ball {
    Point centre;
    float radius;
  };

  /// Whether some point of a ball in L may lie within the limits.
  [[nodiscard]] static bool may_reach(const Point& centre_L, float radius, const SightLimits& limits);

  Cloud points_;
  std::vector<Ball> balls_;  // per block
};

template <typename Visit>
void PointBlocks::sight_within(const SightLimits& limits, const Pose& T_L_A, Visit&& visit) const {
  const Eigen::Matrix3f R = T_L_A.linear().cast<float>();
  const Point t = T_L_A.translation().cast<float>();
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    if (!may_reach(R * balls_[b].centre + t, balls_[b].radius, limits)) {
      continue;
    }
    const std::span<const Point> points = block(b);
    Sightings seen;
    sight_block(points, R, t, seen);
    for (std::size_t i = 0; i < points.size(); ++i) {
      visit(std::as_const(seen), i);
    }
  }
}

}  // namespace hulltrack
