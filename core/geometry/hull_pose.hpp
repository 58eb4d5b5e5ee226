// Where the hull lies: how she has moved since her map was made.
//
// T_W_H takes coordinates of the map (H) to the world's (W); the identity is the place where the map was
// made. Limits, registers and figures speak of one point of the hull, her reference point. Metres, radians. A
// plain value.
#pragma once

#include "core/geometry/se3.hpp"

namespace hulltrack {

struct HullPose {
  Pose T_W_H = Pose::Identity();
  Eigen::Vector3d reference_H = Eigen::Vector3d::Zero();

  /// How far the reference point has moved, W.
  [[nodiscard]] Eigen::Vector3d displacement() const { return T_W_H * reference_H - reference_H; }
  /// Where the reference point is now.
  [[nodiscard]] Eigen::Vector3d reference_W() const { return reference_H + displacement(); }
  /// How the hull has turned: rotation of T_W_H, and its roll, pitch and yaw.
  [[nodiscard]] Eigen::Matrix3d rotation() const { return T_W_H.linear(); }
  [[nodiscard]] Eigen::Vector3d rpy() const { return rpy_from_rotation(T_W_H.linear()); }
};

/// A hull whose reference point has moved by `displacement` and that has turned by `rotation` about it.
[[nodiscard]] inline HullPose moved_hull(const Eigen::Vector3d& displacement, const Eigen::Matrix3d& rotation,
                                         const Eigen::Vector3d& reference_H = Eigen::Vector3d::Zero()) {
  return {pose_about(reference_H, rotation, displacement), reference_H};
}

}  // namespace hulltrack
