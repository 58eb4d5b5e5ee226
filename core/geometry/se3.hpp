// Rigid transforms: SE(3) with the naming, angle and twist conventions of the whole project.
//
// T_a_b takes coordinates in b to coordinates in a: p_a = T_a_b * p_b. Metres, radians, double.
// Roll, pitch, yaw compose as Rz(yaw) * Ry(pitch) * Rx(roll). Twists are [rotation; translation].
// Pure functions; no failure, except that rotations are expected to be orthonormal.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>

namespace hulltrack {

using Pose = Eigen::Isometry3d;
using Twist = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

[[nodiscard]] constexpr double radians(double deg) { return deg * (std::numbers::pi / 180.0); }
[[nodiscard]] constexpr double degrees(double rad) { return rad * (180.0 / std::numbers::pi); }

/// Rz(rpy.z) * Ry(rpy.y) * Rx(rpy.x), rpy in rad.
[[nodiscard]] Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy);

/// Inverse of rotation_from_rpy: pitch in [-pi/2, pi/2]; at |pitch| = pi/2 roll is set to 0.
[[nodiscard]] Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R);

/// Translation xyz in m, then rotation rpy in deg as the configuration gives them.
[[nodiscard]] Pose pose_from_xyz_rpy_deg(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy_deg);

/// p -> R * (p - centre) + centre + shift.
[[nodiscard]] Pose pose_about(const Eigen::Vector3d& centre, const Eigen::Matrix3d& R,
                              const Eigen::Vector3d& shift);

/// Takes the twist of a small motion about one point to its twist about another, which lies `away` from the
/// first.
[[nodiscard]] inline Twist about_point(const Eigen::Vector3d& away, const Twist& twist) {
  Twist moved = twist;
  moved.tail<3>() += twist.head<3>().cross(away);
  return moved;
}

/// [w]x, so that skew(w) * v = w.cross(v).
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& w);

/// SO(3) exponential (Rodrigues) and logarithm; the logarithm's norm is in [0, pi].
[[nodiscard]] Eigen::Matrix3d so3_exp(const Eigen::Vector3d& w);
[[nodiscard]] Eigen::Vector3d so3_log(const Eigen::Matrix3d& R);

/// SE(3) exponential and logarithm of twists [rotation; translation].
[[nodiscard]] Pose se3_exp(const Twist& xi);
[[nodiscard]] Twist se3_log(const Pose& T);

/// Angle of the rotation in rad, in [0, pi].
[[nodiscard]] double rotation_angle(const Eigen::Matrix3d& R);

}  // namespace hulltrack
