// The covariance of the published pose: the fit's, taken to the reference point and W's axes, and what the
// machine's joints add to it.
//
// [rotation; translation], rad and m. Pure. No failure.
#pragma once

#include "core/kinematics/joint_history.hpp"
#include "core/kinematics/loader_kinematics.hpp"

namespace hulltrack {

/// Takes the covariance of a fit, about `centre_H` in H's axes, to that of T_W_H, about the reference point
/// in W's axes.
[[nodiscard]] Matrix6 covariance_at_reference(const Matrix6& about_centre_H, const Eigen::Vector3d& centre_H,
                                              const Eigen::Vector3d& reference_H,
                                              const Eigen::Matrix3d& R_W_H);

/// What errors of the joints' time stamps add. The value of a moving joint is wrong by its speed times the
/// error of its sample's moment. That error is bounded by the PLC's cycle, which is shorter than the time
/// between samples. A joint at rest adds nothing.
[[nodiscard]] Matrix6 covariance_of_joints(const MachineConfig& machine, const JointHistory& joints,
                                           MeasurementTime time, const Eigen::Vector3d& reference_W);

/// 1-sigma along the largest principal axis.
[[nodiscard]] double largest_sigma(const Eigen::Matrix3d& covariance);

}  // namespace hulltrack
