// A map of what stands at the simulated berth: what a survey from the loader would have left after
// registration, voxel filter and the removal of all that is something else.
//
// Points of the surfaces that a LiDAR on the boom saw from one of several stations along the berth (not
// occluded, within range, not too oblique), with 5 mm noise along the ray, one point a voxel. In the frame of
// mesh and stations, metres. The same seed gives the same points. A hull: about 1.5 million points in some
// seconds on two cores.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "daemon/simulator/sensing/mesh.hpp"

namespace hulltrack {

/// Edge of a voxel of a hull's map, of a quay's.
inline constexpr float kHullVoxel = 0.05F;
inline constexpr float kQuayVoxel = 0.10F;

/// `stations`: where the LiDAR stood, at least one; `voxel`: m.
[[nodiscard]] Cloud survey(const TriangleMesh& mesh, const std::vector<Point>& stations, std::uint64_t seed,
                           float voxel = kHullVoxel);

}  // namespace hulltrack
