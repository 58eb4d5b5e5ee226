#include "core/kinematics/loader_kinematics.hpp"

namespace hulltrack {

Pose boom_pose(const MachineConfig& machine, const Joints& joints) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return Eigen::Translation3d(joints.d_x, 0.0, 0.0) * machine.slew *
         AngleAxisd(joints.theta_r, Vector3d::UnitZ()) * machine.luff *
         AngleAxisd(joints.theta_p, Vector3d::UnitY());
}

Pose lidar_pose(const MachineConfig& machine, const Joints& joints, const Pose& T_lidar) {
  return boom_pose(machine, joints) * T_lidar;
}

}  // namespace hulltrack
