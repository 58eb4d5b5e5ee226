// From the fit's covariance to that of the published pose: frames, the reference point, the machine's share.
//
// [rotation; translation], rad and m. Pure. No failure.
#pragma once

#include "core/kinematics/joint_history.hpp"
#include "core/kinematics/loader_kinematics.hpp"

namespace hulltrack {

/// Of a fit about `centre_H` in H's axes, as that of T_W_H about the reference point in W's axes.
[[nodiscard]] Matrix6 covariance_at_reference(const Matrix6& about_centre_H, const Eigen::Vector3d& centre_H,
                                              const Eigen::Vector3d& reference_H,
                                              const Eigen::Matrix3d& R_W_H);

/// What the joints' errors add: a joint that moves is known as well as its moment is, and a sample's moment
/// as well as the PLC's cycle allows, which is shorter than the time between samples. No motion, no error.
[[nodiscard]] Matrix6 covariance_of_joints(const MachineConfig& machine, const JointHistory& joints,
                                           MeasurementTime time, const Eigen::Vector3d& reference_W);

/// 1-sigma along the largest principal axis.
[[nodiscard]] double largest_sigma(const Eigen::Matrix3d& covariance);

}  // namespace hulltrack
