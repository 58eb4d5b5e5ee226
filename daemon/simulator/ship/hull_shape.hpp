// What is the shape of the ship at time t? What changes slowly while she is loaded: the cargo's height and
// the bend of the hull.
//
// Bending is the parabola of Euler's beam under an even load: u(x) = -bend (1 - (2x/L)^2), x from amidships,
// L the ship's length; bend > 0 is a sag (the middle lower), < 0 a hog, 0 the shape of the map. Points are
// displaced vertically, by u alone. Metres, seconds from the first firing.
// A shape changes in steps, because a ray-cast world is built for each; no step bends the hull by more than
// 2 mm or fills a hold by more than a fortieth. Pure functions and plain data; any thread.
#pragma once

#include <cstddef>

#include "daemon/simulator/sensing/mesh.hpp"

namespace hulltrack {

struct HullShape {
  double fill = 0.0;  // of the holds, [0, 1]
  double bend = 0.0;  // m
};

/// A change from one shape to another at an even pace.
class ShapeChange {
 public:
  /// From time 0 to `duration` > 0; the shapes stay before and after.
  ShapeChange(const HullShape& from, const HullShape& to, double duration);

  /// Number of different shapes, at least 1.
  [[nodiscard]] std::size_t shapes() const { return steps_ + 1; }
  /// Which of them the ship has at time t.
  [[nodiscard]] std::size_t at(double t) const;
  /// Precondition: index < shapes().
  [[nodiscard]] HullShape shape(std::size_t index) const;

 private:
  HullShape from_, to_;
  double duration_;
  std::size_t steps_;
};

/// u(x), m.
[[nodiscard]] double deflection(double bend, double ship_length, double x);

/// u'(x): where the ship's axis points, up being positive.
[[nodiscard]] double deflection_slope(double bend, double ship_length, double x);

/// `mesh` (x along the ship, from amidships) with every point displaced by u(x). Long triangles are cut, so
/// that no edge strays by more than a fifth of a millimetre from the parabola of a bend of 0.3 m in 120 m.
[[nodiscard]] TriangleMesh bent(const TriangleMesh& mesh, double bend, double ship_length);

}  // namespace hulltrack
