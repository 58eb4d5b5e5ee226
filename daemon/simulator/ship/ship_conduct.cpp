#include "daemon/simulator/ship/ship_conduct.hpp"

#include <limits>

namespace hulltrack::conduct {
namespace {

constexpr double kPerHour = 1.0 / 3600.0;
constexpr double kForEver = std::numeric_limits<double>::infinity();

}  // namespace

HullMotionConfig sheltered() {
  HullMotionConfig motion;
  motion.surge = {0.05, 50.0, 150.0};
  motion.sway = {0.05, 50.0, 150.0};
  motion.heave = {0.01, 6.0, 15.0};
  motion.roll = {radians(0.10), 6.0, 15.0};
  motion.pitch = {radians(0.03), 6.0, 15.0};
  motion.yaw = {radians(0.03), 50.0, 150.0};
  motion.draft_rate = 1.0 * kPerHour;
  motion.start_displacement = {0.03, -0.02, -0.04};
  motion.start_rpy = {radians(0.04), radians(-0.02), radians(0.03)};
  return motion;
}

HullMotionConfig uneasy() {
  HullMotionConfig motion = sheltered();
  motion.surge = {0.30, 50.0, 150.0};
  motion.sway = {0.20, 30.0, 120.0};
  motion.heave = {0.05, 6.0, 15.0};
  motion.roll = {radians(0.50), 6.0, 15.0};
  motion.pitch = {radians(0.10), 6.0, 15.0};
  motion.yaw = {radians(0.15), 50.0, 150.0};
  return motion;
}

HullMotionConfig loaded() {
  HullMotionConfig motion = sheltered();
  motion.draft_rate = 1.3 * kPerHour;
  motion.start_displacement = {0.05, -0.03, -0.60};
  motion.start_rpy = {radians(0.50), radians(-0.30), radians(0.02)};
  return motion;
}

HullMotionConfig with(HullMotionConfig motion, const std::vector<Course>& courses) {
  motion.courses.insert(motion.courses.end(), courses.begin(), courses.end());
  return motion;
}

HullMotionConfig sinking() {
  HullMotionConfig motion = uneasy();
  motion.draft_rate = 0.0;
  motion.ebb = {0.0, 0.02, 0.01, 2.8};
  return with(motion, {shifted(0.0, {0.0, 0.0, -4.2}, 0.03, 0.015)});
}

HullMotionConfig whole_shift() {
  HullMotionConfig motion = uneasy();
  motion.draft_rate = 0.0;
  motion.ebb = {0.0, 0.004, 0.002, 1.2};
  return with(
      motion,
      {shifted(0.0, {0.0, 0.0, -2.4}, 0.008, 0.004), listing(20.0, 80.0, {radians(0.8), 0.0, 0.0}),
       listing(60.0, 150.0, {0.0, radians(-0.5), 0.0}), listing(140.0, 100.0, {radians(-1.4), 0.0, 0.0})});
}

Course shifted(double start, const Eigen::Vector3d& way, double speed, double acceleration) {
  return {.run = {start, speed, acceleration, way.norm()}, .direction = way.normalized()};
}

Course leaving(double start, const Eigen::Vector3d& direction, double speed, double acceleration,
               double yaw_rate) {
  return {.run = {start, speed, acceleration, kForEver},
          .direction = direction,
          .rpy_rate = {0.0, 0.0, yaw_rate}};
}

Course listing(double start, double duration, const Eigen::Vector3d& rpy) {
  constexpr double kRamp = 4.0;                  // s
  const double at_full_rate = duration - kRamp;  // either ramp covers half of what full rate would
  return {.run = {start, 1.0, 1.0 / kRamp, at_full_rate},
          .direction = Eigen::Vector3d::Zero(),
          .rpy_rate = rpy / at_full_rate};
}

}  // namespace hulltrack::conduct
