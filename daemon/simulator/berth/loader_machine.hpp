// The simulated loader: its installation transforms, where it works, and its own steel in the LiDAR's view.
//
// Frames: B is the boom (mounts are given in it, its origin on the luffing axis, x along the boom), G the
// gantry (origin under the slewing axis at rail level, moved along W's x by the travel). Metres.
// Constants and pure functions; nothing fails.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/box.hpp"
#include "core/kinematics/loader_kinematics.hpp"
#include "daemon/simulator/berth/loader_motion.hpp"
#include "daemon/simulator/sensing/mesh.hpp"

namespace hulltrack {

/// Slewing axis 8 m behind the quay's edge, luffing axis 20.5 m above the rails, 2 m in front of it.
[[nodiscard]] MachineConfig loader_machine();

/// Speeds and accelerations of a loader of this size; a working range that keeps the chute over the holds.
[[nodiscard]] LoaderLimits loader_limits();

/// The same machine at the upper end of what such loaders do, travelling and slewing nearly all the time.
[[nodiscard]] LoaderLimits hurried_loader_limits();

/// The same machine on a pass along the whole ship.
[[nodiscard]] LoaderLimits passing_loader_limits();

/// Where the ore leaves the chute.
[[nodiscard]] Point chute_end_B();

/// Boom and chute, in B.
[[nodiscard]] TriangleMesh boom_mesh();

/// Portal and tower, in G.
[[nodiscard]] TriangleMesh portal_mesh();

/// T_lidar of the places for LiDARs at the boom's end, on either side of the chute's head.
[[nodiscard]] std::span<const Pose> lidar_brackets();

/// Boxes in L around everything of boom_mesh, for `exclude`; T_lidar = mount in B.
[[nodiscard]] std::vector<Box> own_machine_boxes(const Pose& T_lidar);

}  // namespace hulltrack
