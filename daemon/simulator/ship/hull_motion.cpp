#include "daemon/simulator/ship/hull_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "daemon/simulator/random.hpp"

namespace hulltrack {

double run_distance(const Run& run, double t) {
  const double elapsed = t - run.start;
  if (elapsed <= 0.0 || run.distance <= 0.0) return 0.0;
  // A run too short for its speed never reaches it.
  const double peak = std::min(run.speed, std::sqrt(run.acceleration * run.distance));
  const double ramp = peak / run.acceleration;
  const double ramp_distance = 0.5 * peak * ramp;
  if (elapsed < ramp) return 0.5 * run.acceleration * elapsed * elapsed;
  const double cruise = (run.distance - 2.0 * ramp_distance) / peak;
  if (elapsed < ramp + cruise) return ramp_distance + peak * (elapsed - ramp);
  const double left = std::max(0.0, 2.0 * ramp + cruise - elapsed);
  return run.distance - 0.5 * run.acceleration * left * left;
}

std::optional<double> under_way(const HullMotionConfig& motion) {
  for (const Course& course : motion.courses)
    if (course.direction.head<2>().norm() > 0.0) return course.run.start;
  return std::nullopt;
}

HullMotion::Waves HullMotion::waves(const Swing& swing, std::uint64_t seed, std::uint64_t stream) {
  RandomStream random(seed, stream);
  Waves result{};
  double total = 0.0;
  for (int i = 0; i < kSines; ++i) {
    // Periods spread evenly in the logarithm and drawn within their share: no two alike.
    const double share = (static_cast<double>(i) + random.uniform(0.1, 0.9)) / kSines;
    const double period = swing.shortest * std::pow(swing.longest / swing.shortest, share);
    Wave& wave = result.at(static_cast<std::size_t>(i));
    wave = {random.uniform(0.4, 1.0), 2.0 * std::numbers::pi / period,
            random.uniform(0.0, 2.0 * std::numbers::pi)};
    total += wave.amplitude;
  }
  for (Wave& wave : result) wave.amplitude *= swing.amplitude / total;
  return result;
}

HullMotion::HullMotion(const HullMotionConfig& config, const Eigen::Vector3d& reference_point_H,
                       std::uint64_t seed)
    : config_(config), reference_point_H_(reference_point_H) {
  const std::array<Swing, 6> swings = {config.surge, config.sway,  config.heave,
                                       config.roll,  config.pitch, config.yaw};
  constexpr std::uint64_t kStream = 100;
  for (std::size_t i = 0; i < swings.size(); ++i) waves_.at(i) = waves(swings.at(i), seed, kStream + i);
}

ShipPose HullMotion::pose(double t) const {
  std::array<double, 6> swing{};
  for (std::size_t i = 0; i < swing.size(); ++i)
    for (const Wave& wave : waves_[i])
      swing[i] += wave.amplitude * std::sin(wave.angular_frequency * t + wave.phase);
  ShipPose pose{config_.start_displacement, config_.start_rpy};
  pose.displacement += Eigen::Vector3d(swing[0], swing[1], swing[2] - config_.draft_rate * t);
  pose.rpy += Eigen::Vector3d(swing[3], swing[4], swing[5]);
  pose.displacement.z() -= ebb(t);
  for (const Course& course : config_.courses) {
    const double way = run_distance(course.run, t);
    pose.displacement += way * course.direction;
    pose.rpy += way / course.run.speed * course.rpy_rate;
  }
  return pose;
}

double HullMotion::ebb(double t) const { return run_distance(config_.ebb, t); }

Pose HullMotion::transform(const ShipPose& pose) const {
  return pose_about(reference_point_H_, rotation_from_rpy(pose.rpy), pose.displacement);
}

Pose HullMotion::T_W_H(double t) const { return transform(pose(t)); }

}  // namespace hulltrack
