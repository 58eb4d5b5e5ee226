#include "core/witness/machine_wear.hpp"

#include <algorithm>

namespace hulltrack {
namespace {

// Limits of the wear class (ICD 3.1).
constexpr double kBoomSag = 0.10;        // m, at the boom's end
const double kBacklash = radians(0.10);  // slew and luff
constexpr double kTravelDrift = 0.03;    // m
const double kAngleDrift = radians(0.05);
constexpr double kTravelSlip = 0.001;  // share of d_x
constexpr double kMountShift = 0.02;   // m
const double kMountTurn = radians(0.10);
constexpr double kLatency = 0.010;  // s

// The boom's end turns by this times sag / length: a beam held at one end and loaded at the other.
constexpr double kTurnOfSag = 1.5;
constexpr double kShortestBoom = 1.0;  // m, keeps the division finite

/// A turn by 1 rad about the line along `axis` through the point `through`, as a twist about `centre`.
Twist about(const Eigen::Vector3d& axis, const Eigen::Vector3d& through, const Eigen::Vector3d& centre) {
  Twist twist;
  twist << axis, axis.cross(centre - through);
  return twist;
}

Twist shift(const Eigen::Vector3d& by) {
  Twist twist;
  twist << Eigen::Vector3d::Zero(), by;
  return twist;
}

/// Frames of the slewing and the luffing axis in W.
struct Axes {
  Pose T_W_slew, T_W_luff;
};
Axes axes_of(const MachineConfig& machine, const Joints& joints) {
  const Pose T_W_slew = Eigen::Translation3d(joints.d_x, 0.0, 0.0) * machine.slew;
  return {T_W_slew, T_W_slew * Eigen::AngleAxisd(joints.theta_r, Eigen::Vector3d::UnitZ()) * machine.luff};
}

/// The boom's own axes in W, as columns.
Eigen::Matrix3d boom_axes(const MachineConfig& machine, const Joints& joints) {
  return axes_of(machine, joints).T_W_luff.linear() *
         Eigen::AngleAxisd(joints.theta_p, Eigen::Vector3d::UnitY()).toRotationMatrix();
}

}  // namespace

const char* joint_name(JointName joint) {
  static constexpr std::array<const char*, 3> kNames = {"travel", "slew", "luff"};
  return kNames.at(static_cast<std::size_t>(joint));
}

Twist joint_twist(const MachineConfig& machine, const MachineStand& stand, JointName joint,
                  const Eigen::Vector3d& centre_W) {
  const Axes axes = axes_of(machine, stand.joints);
  switch (joint) {
    case JointName::travel:
      return shift(Eigen::Vector3d::UnitX());
    case JointName::slew:
      return about(axes.T_W_slew.linear().col(2), axes.T_W_slew.translation(), centre_W);
    case JointName::luff:
      return about(axes.T_W_luff.linear().col(1), axes.T_W_luff.translation(), centre_W);
  }
  return Twist::Zero();
}

Twist lateness_twist(const MachineConfig& machine, const MachineStand& stand,
                     const Eigen::Vector3d& centre_W) {
  return -stand.rate.d_x * joint_twist(machine, stand, JointName::travel, centre_W) -
         stand.rate.theta_r * joint_twist(machine, stand, JointName::slew, centre_W) -
         stand.rate.theta_p * joint_twist(machine, stand, JointName::luff, centre_W);
}

std::array<Twist, 6> mount_twists(const MachineStand& stand, const Eigen::Vector3d& centre_W) {
  std::array<Twist, 6> twists;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    twists[static_cast<std::size_t>(i)] = shift(axis);
    twists[static_cast<std::size_t>(i) + 3] = about(axis, stand.sensor_W, centre_W);
  }
  return twists;
}

Twist carried_by_boom(const MachineConfig& machine, const MachineStand& then, const MachineStand& now,
                      const Twist& off) {
  const Eigen::Matrix3d turned = boom_axes(machine, now.joints) * boom_axes(machine, then.joints).transpose();
  Twist carried;
  carried << turned * off.head<3>(), turned * off.tail<3>();
  return carried;
}

std::vector<Twist> fast_wear_twists(const MachineConfig& machine, const MachineStand& stand,
                                    const Eigen::Vector3d& centre_W) {
  // Sag is two kinds of wear, a shift and a turn of the boom's end: their ratio depends on the boom.
  const Axes axes = axes_of(machine, stand.joints);
  const double boom =
      std::max(kShortestBoom, (stand.sensor_W - axes.T_W_luff.translation()).head<2>().norm());
  return {kBacklash * joint_twist(machine, stand, JointName::slew, centre_W),
          kBacklash * joint_twist(machine, stand, JointName::luff, centre_W),
          kLatency * lateness_twist(machine, stand, centre_W), kBoomSag * shift(Eigen::Vector3d::UnitZ()),
          kTurnOfSag * kBoomSag / boom * about(axes.T_W_luff.linear().col(1), stand.sensor_W, centre_W)};
}

std::vector<Twist> wear_twists(const MachineConfig& machine, const MachineStand& stand,
                               const Eigen::Vector3d& centre_W) {
  const Twist travel = joint_twist(machine, stand, JointName::travel, centre_W);
  std::vector<Twist> twists = fast_wear_twists(machine, stand, centre_W);
  twists.push_back(kTravelDrift * travel);
  twists.push_back(kTravelSlip * stand.joints.d_x * travel);
  twists.push_back(kAngleDrift * joint_twist(machine, stand, JointName::slew, centre_W));
  twists.push_back(kAngleDrift * joint_twist(machine, stand, JointName::luff, centre_W));
  const std::array<Twist, 6> mount = mount_twists(stand, centre_W);
  for (std::size_t i = 0; i < mount.size(); ++i) {
    twists.push_back((i < 3 ? kMountShift : kMountTurn) * mount[i]);
  }
  return twists;
}

}  // namespace hulltrack
