// How does a hull bend, and how far? Hog and sag as one parameter besides the rigid pose.
//
// A loaded hull bends much like a parabola, u(x) = -d (1 - (2 x / L)^2): d, the sag of amidships against the
// ends (negative: hog), up to L / 1000. The rigid pose is that of the hull at its reference point, so that it
// is right where it is needed whatever d is: seen from there a part at distance s along the ship stands
// d (2 s / L)^2 higher than in the map. Frame H, X along the ship; metres. Pure.
#pragma once

#include "core/geometry/se3.hpp"

namespace hulltrack {

/// The curve that a hull of the mapped length bends in, about its reference point.
struct BendShape {
  double reference_x = 0.0;  // m
  double length = 1.0;       // m, > 0

  /// Rise at x for each metre of d.
  [[nodiscard]] double rise(double x) const {
    const double s = 2.0 * (x - reference_x) / length;
    return s * s;
  }
};

/// d and how sure that is. sigma = 0: known exactly, not estimated.
struct Bend {
  double d = 0.0;      // m
  double sigma = 0.0;  // m
};

}  // namespace hulltrack
