// How would wear or a fault of the machine show: by which twist is the sensor then not where it is put?
//
// A machine that is worn within its class (ICD 3.1) is nobody's fault: boom sag, backlash, drift of encoders,
// slip of the travel, a mount and a latency that are a little off. Each moves the sensor along a twist of its
// own, by up to its class. A joint that reads `a` too much moves it by `a` along its joint's axis.
// Frame W, metres, radians. Pure.
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

/// Slower than this, m/s and rad/s by JointName, a joint stands: an encoder's step between two frames. 100 ms
/// of lateness are then 3 mm or 0.008 deg.
inline const Eigen::Vector3d kStandsBelow(0.03, radians(0.08), radians(0.08));

/// Where the machine is while a scan is taken.
struct MachineStand {
  Joints joints;
  Joints rate;  // a second
  Eigen::Vector3d sensor_W = Eigen::Vector3d::Zero();
};

/// Twist [rotation; translation] about `centre_W` for one unit (rad, m) that the joint reads too much.
[[nodiscard]] Twist joint_twist(const MachineConfig& machine, const MachineStand& stand, JointName joint,
                                const Eigen::Vector3d& centre_W);

/// Twists about `centre_W` of a sensor that hangs a metre off along an axis of W (the first three), or is
/// turned by a radian about one.
[[nodiscard]] std::array<Twist, 6> mount_twists(const MachineStand& stand, const Eigen::Vector3d& centre_W);

/// How a sensor that was off by a twist about its place as the machine stood `then` is off about its place
/// `now`, if the boom carries what is wrong with it.
[[nodiscard]] Twist carried_by_boom(const MachineConfig& machine, const MachineStand& then,
                                    const MachineStand& now, const Twist& off);

/// All that wear within the class can do, each term at its limit: twists about `centre_W`.
[[nodiscard]] std::vector<Twist> wear_twists(const MachineConfig& machine, const MachineStand& stand,
                                             const Eigen::Vector3d& centre_W);

/// What of it can change within seconds: backlash, the sag of a boom that is loaded, latency.
[[nodiscard]] std::vector<Twist> fast_wear_twists(const MachineConfig& machine, const MachineStand& stand,
                                                  const Eigen::Vector3d& centre_W);

/// Twist about `centre_W` of joint values that are a second older than they are taken to be.
[[nodiscard]] Twist lateness_twist(const MachineConfig& machine, const MachineStand& stand,
                                   const Eigen::Vector3d& centre_W);

}  // namespace hulltrack
