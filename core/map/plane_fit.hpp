// Which plane do the neighbours of a map point lie on, and how well?
//
// Principal component analysis. Frame of the cloud, metres. Pure. Precondition: at least one neighbour.
// Cost: some 20 flops a neighbour, one 3 x 3 eigenproblem.
#pragma once

#include <array>
#include <span>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct PlaneFit {
  Eigen::Vector3d centroid;      // of the neighbours, as seen from the point, m
  Eigen::Vector3d normal;        // unit, sign arbitrary
  std::array<double, 3> spread;  // RMS, m: distance from the plane; smaller, larger extent in the plane
};

[[nodiscard]] PlaneFit fit_plane(const Point& p, std::span<const Point> neighbours);

}  // namespace hulltrack
