// The bending of a hull (hog and sag) as one parameter d besides the rigid pose.
//
// A loaded hull bends much like a parabola, u(x) = -d (1 - (2 x / L)^2). d is how far amidships sags against
// the ends, up to L / 1000; negative d is hog. The rigid pose is that of the hull at its reference point,
// where the pose is needed: there d changes nothing. A part at distance s from it along the ship stands
// d (2 s / L)^2 higher than the map has it.
// Frame H, X along the ship; metres. Pure.
#pragma once

#include "core/geometry/se3.hpp"

namespace hulltrack {

/// The parabola in which the hull bends: its vertex and its length.
struct BendShape {
  double reference_x = 0.0;  // of the hull's reference point, m
  double length = 1.0;       // of the mapped hull, m, > 0

  /// How much higher a part at x stands for each metre of d.
  [[nodiscard]] double rise(double x) const {
    const double s = 2.0 * (x - reference_x) / length;
    return s * s;
  }
};

/// d with its 1-sigma uncertainty. sigma = 0: a fit keeps this d and does not estimate it.
struct Bend {
  double d = 0.0;      // m
  double sigma = 0.0;  // m
};

}  // namespace hulltrack
