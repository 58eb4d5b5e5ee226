// The map of the simulated ship: what a survey from the loader would have left after registration, voxel
// filter and the removal of all that is not hull.
//
// Points of the empty ship's surfaces that a LiDAR on the boom saw from one of several stations along the
// ship (not occluded, within range, not too oblique), with 5 mm noise along the ray, one point a 5 cm voxel.
// In H, metres. The same seed gives the same points. About 1.5 million points in some seconds on two cores.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "daemon/simulator/mesh.hpp"

namespace hulltrack {

/// `stations_H`: where the LiDAR stood, at least one.
[[nodiscard]] Cloud survey(const TriangleMesh& hull_mesh_H, const std::vector<Point>& stations_H,
                           std::uint64_t seed);

}  // namespace hulltrack
