#include "core/geometry/se3.hpp"

#include <cmath>

namespace hulltrack {
namespace {

// Below this angle (rad) the closed forms lose digits and their series are exact to double.
constexpr double kSmallAngle = 1e-5;

}  // namespace

Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R) {
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(0.0 - R(2, 0), cos_pitch);  // no negative zero
  if (cos_pitch < 1e-9) {
    return {0.0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  }
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Pose pose_from_xyz_rpy_deg(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy_deg) {
  Pose T = Pose::Identity();
  T.linear() = rotation_from_rpy(rpy_deg * radians(1.0));
  T.translation() = xyz;
  return T;
}

Pose pose_about(const Eigen::Vector3d& centre, const Eigen::Matrix3d& R, const Eigen::Vector3d& shift) {
  Pose T = Pose::Identity();
  T.linear() = R;
  T.translation() = centre + shift - R * centre;
  return T;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& w) {
  Eigen::Matrix3d W;
  W << 0.0, -w.z(), w.y(),  //
      w.z(), 0.0, -w.x(),   //
      -w.y(), w.x(), 0.0;
  return W;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  const Eigen::Matrix3d W = skew(w);
  if (angle < kSmallAngle) {
    return Eigen::Matrix3d::Identity() + W + 0.5 * W * W;
  }
  const double half = std::sin(0.5 * angle) / angle;
  return Eigen::Matrix3d::Identity() + std::sin(angle) / angle * W + 2.0 * half * half * W * W;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& R) {
  // Through the unit quaternion: well conditioned from 0 to pi.
  Eigen::Quaterniond q(R);
  q.normalize();
  if (q.w() < 0.0) {
    q.coeffs() = -q.coeffs();
  }
  const double sin_half = q.vec().norm();
  if (sin_half < kSmallAngle) {
    return 2.0 * q.vec();
  }
  return 2.0 * std::atan2(sin_half, q.w()) / sin_half * q.vec();
}

Pose se3_exp(const Twist& xi) {
  const Eigen::Vector3d w = xi.head<3>();
  const double angle = w.norm();
  const Eigen::Matrix3d W = skew(w);
  Eigen::Matrix3d V = Eigen::Matrix3d::Identity();
  if (angle < kSmallAngle) {
    V += 0.5 * W + W * W / 6.0;
  } else {
    const double half = std::sin(0.5 * angle) / angle;
    V += 2.0 * half * half * W + (1.0 - std::sin(angle) / angle) / (angle * angle) * W * W;
  }
  Pose T = Pose::Identity();
  T.linear() = so3_exp(w);
  T.translation() = V * xi.tail<3>();
  return T;
}

Twist se3_log(const Pose& T) {
  const Eigen::Vector3d w = so3_log(T.linear());
  const double angle = w.norm();
  const Eigen::Matrix3d W = skew(w);
  Eigen::Matrix3d V_inverse = Eigen::Matrix3d::Identity() - 0.5 * W;
  if (angle < kSmallAngle) {
    V_inverse += W * W / 12.0;
  } else {
    const double half = 0.5 * angle;
    V_inverse += (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle) * W * W;
  }
  Twist xi;
  xi << w, V_inverse * T.translation();
  return xi;
}

double rotation_angle(const Eigen::Matrix3d& R) { return so3_log(R).norm(); }

}  // namespace hulltrack
