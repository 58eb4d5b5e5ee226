// Axis-aligned boxes, metres, in the frame that their owner says.
#pragma once

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct Box {
  Point min = Point::Zero();
  Point max = Point::Zero();
  [[nodiscard]] bool contains(const Point& p) const {
    return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
  }
};

}  // namespace hulltrack
