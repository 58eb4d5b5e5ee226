// Axis-aligned boxes, metres, in the frame that their owner says.
#pragma once

#include <cassert>
#include <span>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct Box {
  Point min = Point::Zero();
  Point max = Point::Zero();
  [[nodiscard]] bool contains(const Point& p) const {
    return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
  }
};

/// The tight box of some points: at least one, all finite.
[[nodiscard]] inline Box bounding_box(std::span<const Point> points) {
  assert(!points.empty());
  Box box{points.front(), points.front()};
  for (const Point& p : points) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

}  // namespace hulltrack
