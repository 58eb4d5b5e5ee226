#include "core/geometry/point_blocks.hpp"

#include <cmath>
#include <numbers>

#include "core/geometry/box.hpp"
#include "core/geometry/z_order.hpp"

namespace hulltrack {

PointBlocks::PointBlocks(std::span<const Point> cloud) {
  for (const std::uint32_t i : z_order(cloud)) {
    points_.push_back(cloud[i]);
  }
  for (std::size_t b = 0; b * Sightings::kBlock < points_.size(); ++b) {
    const Box box = bounding_box(block(b));
    Ball& ball = balls_.emplace_back(Ball{0.5F * (box.min + box.max), 0.0F});
    for (const Point& p : block(b)) {
      ball.radius = std::max(ball.radius, (p - ball.centre).norm());
    }
  }
}

bool PointBlocks::may_reach(const Point& centre_L, float radius, const SightLimits& limits) {
  constexpr float kRounding = 1e-3F;  // m and rad: far more than that of floats within 1 km
  constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;
  const float distance2 = centre_L.squaredNorm();
  const float reach = limits.range + radius + kRounding;
  if (distance2 > reach * reach) {
    return false;
  }
  const float beyond2 = distance2 - radius * radius;
  if (!(beyond2 > 0.0F)) {
    return true;  // the sensor is inside of the ball
  }
  // Seen from L the ball is a disc around its centre's direction: no point of it is higher or lower than the
  // centre by more than the disc's angular radius.
  const float elevation = fast_atan2(centre_L.z(), centre_L.head<2>().norm());
  const float around = fast_atan2(radius, std::sqrt(beyond2)) + kRounding;
  const float lowest = (static_cast<float>(limits.lowest_row) - 90.0F) * kDegree;
  const float highest = (static_cast<float>(limits.highest_row) - 89.0F) * kDegree;
  return elevation + around >= lowest && elevation - around <= highest;
}

}  // namespace hulltrack
