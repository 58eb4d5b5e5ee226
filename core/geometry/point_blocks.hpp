// A fixed cloud in blocks of neighbours, each in a ball: what is out of a sensor's range is passed over
// whole.
//
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

namespace hulltrack {

class PointBlocks {
 public:
  explicit PointBlocks(std::span<const Point> cloud);

  /// The points, neighbours together: every Sightings::kBlock of them are a block.
  [[nodiscard]] const Cloud& points() const { return points_; }

  /// As sight(), in blocks of which some point may lie within `range` (m) of L's origin: calls
  /// visit(sightings, index therein) for all points of those.
  template <typename Visit>
  void sight_within(float range, const Pose& T_L_A, Visit&& visit) const;

 private:
  [[nodiscard]] std::span<const Point> block(std::size_t b) const {
    const std::size_t first = b * Sightings::kBlock;
    return std::span(points_).subspan(first, std::min(Sightings::kBlock, points_.size() - first));
  }

  struct Ball {
    Point centre;
    float radius;
  };

  Cloud points_;
  std::vector<Ball> balls_;  // per block
};

template <typename Visit>
void PointBlocks::sight_within(float range, const Pose& T_L_A, Visit&& visit) const {
  constexpr float kRounding = 1e-3F;  // m: far more than that of floats within 1 km
  const Eigen::Matrix3f R = T_L_A.linear().cast<float>();
  const Point t = T_L_A.translation().cast<float>();
  for (std::size_t b = 0; b < balls_.size(); ++b) {
    if ((R * balls_[b].centre + t).norm() > range + balls_[b].radius + kRounding) {
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
