// Axis-aligned boxes, metres, in the frame that their owner says.
#pragma once

#include <cassert>
#include <limits>
#include <span>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct Box {
  Point min = Point::Zero();
  Point max = Point::Zero();

  /// The box of no points: contains nothing, and grows to the first point that is added.
  [[nodiscard]] static Box none() {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    return {Point::Constant(kFar), Point::Constant(-kFar)};
  }
  /// Grows so that it contains p.
  void add(const Point& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  /// Distance between opposite corners; 0 for a box of no points.
  [[nodiscard]] float diagonal() const {
    return (max.array() >= min.array()).all() ? (max - min).norm() : 0.0F;
  }
  [[nodiscard]] bool contains(const Point& p) const {
    return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
  }
};

/// The tight box of some points: at least one, all finite.
[[nodiscard]] inline Box bounding_box(std::span<const Point> points) {
  assert(!points.empty());
  Box box = Box::none();
  for (const Point& p : points) {
    box.add(p);
  }
  return box;
}

}  // namespace hulltrack
