#include "core/geometry/point_blocks.hpp"

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

}  // namespace hulltrack
