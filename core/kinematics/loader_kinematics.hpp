// Forward kinematics of the gantry loader: joints -> T_W_L of each LiDAR.
//
// T_W_L = Trans_x(d_x) * T_slew * Rot_z(theta_r) * T_luff * Rot_y(theta_p) * T_lidar
// This is T_trans * T_rot * T_tilt of Guo 2025, 2.2, with the installation transforms between the joints.
// The paper inverts its chain (s_world = T_init^-1 s). No inverse is applied here: with these factors the
// chain already takes L to W. Metres and radians. Pure.
#pragma once

#include <vector>

#include "core/geometry/se3.hpp"
#include "core/kinematics/joints.hpp"

namespace hulltrack {

/// Constant installation transforms; with identities the chain has the three joints alone.
struct MachineConfig {
  Pose slew = Pose::Identity();  // gantry -> slewing axis
  Pose luff = Pose::Identity();  // slewing platform -> luffing axis
};

/// T_W_B: the frame of the boom in W. Mounts T_lidar are given in the boom's frame.
[[nodiscard]] Pose boom_pose(const MachineConfig& machine, const Joints& joints);

/// T_W_L for a LiDAR mounted at T_lidar on the boom.
[[nodiscard]] Pose lidar_pose(const MachineConfig& machine, const Joints& joints, const Pose& T_lidar);

}  // namespace hulltrack
