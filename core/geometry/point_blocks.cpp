#include "core/geometry/point_blocks.hpp"

#include "core/geometry/z_order.hpp"

namespace hulltrack {

PointBlocks::PointBlocks(std::span<const Point> cloud) {
  for (const std::uint32_t i : z_order(cloud)) {
    points_.push_back(cloud[i]);
  }
  for (std::size_t first = 0; first < points_.size(); first += Sightings::kBlock) {
    const auto block = std::span(points_).subspan(first, std::min(Sightings::kBlock, points_.size() - first));
    Point low = block.front();
    Point high = block.front();
    for (const Point& p : block) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    Ball& ball = balls_.emplace_back(Ball{0.5F * (low + high), 0.0F});
    for (const Point& p : block) {
      ball.radius = std::max(ball.radius, (p - ball.centre).norm());
    }
  }
}

}  // namespace hulltrack
