// The quay's top as one large plane: as configured, or as a session finds it by itself.
//
// Input: returns that are not the hull's. Most of them lie on the quay's top, fewer on what stands on it.
// Planes through three returns are tried (RANSAC); the plane that most returns agree with is fitted to them.
// Frame W, metres, radians. Pure. Failure: no plane if fewer than half agree with one, if they lie too close
// together to tell its slope, or if it slopes by more than a quay does. Cost: 0.5 ms for 6,000 returns.
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

/// A quay's top as it was found in returns; it is as wrong as the joints were then.
struct SeenTop {
  QuayPlane plane;
  Box area_W;                // from the 5th to the 95th percentile of the returns on it, along X and along Y
  Eigen::Vector3d middle_W;  // mean of the returns on it: an error of the slope turns the plane about it
  double sigma_slope = 0.0;  // of the slope, rad, about the axis that is known worse
};

constexpr double kSteepestQuay = 0.0873;  // rad, 5 deg: the largest [quay] slope

/// The top, if there is one. `returns_W`: returns that are not the hull's, in any order.
[[nodiscard]] std::optional<SeenTop> find_quay_top(std::span<const Point> returns_W);

}  // namespace hulltrack
