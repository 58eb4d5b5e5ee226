// A few points of a cloud, evenly taken in its order.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// All of `cloud`, or `most` points of it: one of each of `most` equal parts. The point's place in its part
/// differs from part to part: in the order of firing, a fixed place could always be the same laser's.
inline void take_evenly(const Cloud& cloud, std::size_t most, Cloud& out) {
  if (cloud.size() <= most) {
    out = cloud;
    return;
  }
  out.clear();
  const double stretch = static_cast<double>(cloud.size()) / static_cast<double>(most);
  double golden = 0.0;  // multiples of the golden ratio fill 0..1 evenly
  for (std::size_t i = 0; i < most; ++i) {
    out.push_back(cloud[static_cast<std::size_t>(stretch * (static_cast<double>(i) + golden))]);
    golden += std::numbers::phi - 1.0;
    golden -= std::floor(golden);
  }
}

}  // namespace hulltrack
