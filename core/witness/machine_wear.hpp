// By which twist is the sensor misplaced for each kind of wear, and for each joint that reads wrongly?
//
// The wear class (ICD 3.1) is what a machine may be off without being at fault: boom sag, backlash, drift of
// encoders, slip of the travel, and a mount and a latency that are a little off. Each kind gives one twist
// [rotation; translation], at its limit. A joint gives the twist for one unit that it reads too much.
// Input: the kinematics and where the machine stands. Frame W; metres, radians. Pure. No failure.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/se3.hpp"
#include "core/kinematics/joint_history.hpp"
#include "core/kinematics/loader_kinematics.hpp"

namespace hulltrack {

enum class JointName { travel, slew, luff };
inline constexpr std::array kAllJoints = {JointName::travel, JointName::slew, JointName::luff};
[[nodiscard]] const char* joint_name(JointName joint);

/// A joint that is slower than this counts as standing, by JointName, m/s and rad/s. It is an encoder's step
/// between two frames. Joint values that are 100 ms late are then off by 3 mm or 0.008 deg.
inline const Eigen::Vector3d kStandsBelow(0.03, radians(0.08), radians(0.08));

/// Where the machine stands, and how fast it moves, at the middle of a scan.
struct MachineStand {
  Joints joints;
  Joints rate;  // speeds of the joints, m/s and rad/s
  Eigen::Vector3d sensor_W = Eigen::Vector3d::Zero();
};

/// Twist about `centre_W` for one unit (m or rad) that the joint reads too much.
[[nodiscard]] Twist joint_twist(const MachineConfig& machine, const MachineStand& stand, JointName joint,
                                const Eigen::Vector3d& centre_W);

/// Twists about `centre_W` of a wrong mount: the sensor shifted by 1 m along X, Y, Z of W, then turned by 1
/// rad about X, Y, Z through its own position.
[[nodiscard]] std::array<Twist, 6> mount_twists(const MachineStand& stand, const Eigen::Vector3d& centre_W);

/// The error `off` of a sensor (a twist about its own position) when the machine stands as `now`, if it was
/// `off` when it stood as `then` and the error turns with the boom.
[[nodiscard]] Twist carried_by_boom(const MachineConfig& machine, const MachineStand& then,
                                    const MachineStand& now, const Twist& off);

/// The twists about `centre_W` of all kinds of wear, each at its limit.
[[nodiscard]] std::vector<Twist> wear_twists(const MachineConfig& machine, const MachineStand& stand,
                                             const Eigen::Vector3d& centre_W);

/// The same of the kinds that can change within seconds: backlash, latency, the sag of a boom under load.
[[nodiscard]] std::vector<Twist> fast_wear_twists(const MachineConfig& machine, const MachineStand& stand,
                                                  const Eigen::Vector3d& centre_W);

/// Twist about `centre_W` if the joint values are one second older than they are taken to be.
[[nodiscard]] Twist lateness_twist(const MachineConfig& machine, const MachineStand& stand,
                                   const Eigen::Vector3d& centre_W);

}  // namespace hulltrack
