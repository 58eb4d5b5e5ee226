#include "core/localisation/pose_covariance.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

// Sigma of a moment in units of the time between samples: 1 / sqrt(12) / sqrt(2), rounded. The error of a
// sample's moment is uniform over the PLC's cycle, at most the time between samples: 1 / sqrt(12). A hull is
// in view for as long as two samples, whose errors are independent: 1 / sqrt(2).
constexpr double kMomentShare = 0.2;

/// Twist [rotation; translation of reference_W] that turns one boom pose into another.
Twist twist_between(const Pose& from, const Pose& to, const Eigen::Vector3d& reference_W) {
  const Pose step = to * from.inverse();
  Twist twist;
  twist << so3_log(step.linear()), step * reference_W - reference_W;
  return twist;
}

}  // namespace

Matrix6 covariance_at_reference(const Matrix6& about_centre_H, const Eigen::Vector3d& centre_H,
                                const Eigen::Vector3d& reference_H, const Eigen::Matrix3d& R_W_H) {
  Matrix6 to_reference = Matrix6::Zero();
  to_reference.topLeftCorner<3, 3>() = R_W_H;
  to_reference.bottomRightCorner<3, 3>() = R_W_H;
  to_reference.bottomLeftCorner<3, 3>() = -R_W_H * skew(reference_H - centre_H);
  return to_reference * about_centre_H * to_reference.transpose();
}

Matrix6 covariance_of_joints(const MachineConfig& machine, const JointHistory& joints, MeasurementTime time,
                             const Eigen::Vector3d& reference_W) {
  const std::optional<JointHistory::State> motion = joints.motion_at(time);
  Matrix6 covariance = Matrix6::Zero();
  if (!motion) {
    return covariance;
  }
  const double moment = kMomentShare * to_seconds(motion->spacing);
  const Pose here = boom_pose(machine, motion->joints);
  const auto add = [&](Joints moved) {
    const Twist twist = twist_between(here, boom_pose(machine, moved), reference_W);
    covariance += twist * twist.transpose();
  };
  Joints moved = motion->joints;
  moved.d_x += moment * motion->rate.d_x;
  add(moved);
  moved = motion->joints;
  moved.theta_r += moment * motion->rate.theta_r;
  add(moved);
  moved = motion->joints;
  moved.theta_p += moment * motion->rate.theta_p;
  add(moved);
  return covariance;
}

double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
}

}  // namespace hulltrack
