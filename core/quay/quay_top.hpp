// The quay's top as one large plane: as configured, or as a session finds it by itself.
//
// Of returns that are not the hull's most lie on the quay's top; what stands on it rises out of it and is
// less. The plane that most returns agree on is found by trying planes through three of them, then fitted.
// Frame W, metres, radians. Pure. Failure: no plane, where fewer than half agree on one, where they lie too
// close together to tell its slope, or where it slopes by more than a quay does. Cost: 0.5 ms for 6,000
// returns.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/geometry/box.hpp"

namespace hulltrack {

/// z = height + tan(slope.x) * x + tan(slope.y) * y in W.
struct QuayPlane {
  double height = 0.0;                                           // m, at W's origin
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();               // rad, along X and along Y
  [[nodiscard]] Eigen::Vector3d normal() const;                  // unit, upward
  [[nodiscard]] double above(const Eigen::Vector3d& p_W) const;  // along the normal, m
};

/// A quay's top as it was seen with the joints of that moment.
struct SeenTop {
  QuayPlane plane;
  Box area_W;                // of nine in ten returns on it, along X and along Y
  Eigen::Vector3d middle_W;  // of the returns on it: what its tilt is known about
  double sigma_slope = 0.0;  // rad, of the axis that is known worse, for any part of the area
};

constexpr double kSteepestQuay = 0.0873;  // rad, 5 deg: what [quay] slope may be

/// `returns_W`: of what is not hull; in any order.
[[nodiscard]] std::optional<SeenTop> find_quay_top(std::span<const Point> returns_W);

}  // namespace hulltrack
