// Where is the hull at time t? The motion of a moored ship, and of one that leaves.
//
// The pose is that of ICD 1: displacement of the reference point in W and roll, pitch, yaw since the map
// was made. Mooring motion is a sum of incommensurate sines per degree of freedom, phases from the seed;
// draft, tide and whatever else she does - warping, jerks, listing, departure - come on top.
// Seconds from the first firing, metres, radians.
// Pure after construction: any time may be asked, in any order, from any thread. About 0.5 us.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/se3.hpp"

namespace hulltrack {

/// One degree of freedom swings within +-amplitude with periods in [shortest, longest].
struct Swing {
  double amplitude = 0.0;  // m or rad, the largest value that all sines together can reach
  double shortest = 1.0;   // s
  double longest = 1.0;    // s
};

/// A change that begins at `start` and speeds up to `speed` with `acceleration`; ends after `distance` as
/// gently as it began. Infinite distance: it goes on. For a translation in m, m/s, m/s2; a pure turn counts
/// in anything.
struct Run {
  double start = 0.0;         // s
  double speed = 0.0;         // m/s
  double acceleration = 0.1;  // m/s2
  double distance = 0.0;      // m
};

/// Something that the ship does beside lying at her lines.
struct Course {
  Run run;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // displacement in W per unit of the run
  Eigen::Vector3d rpy_rate = Eigen::Vector3d::Zero();    // rad/s while at full speed, after the same ramps
};

struct HullMotionConfig {
  Eigen::Vector3d start_displacement = Eigen::Vector3d::Zero();  // since the map was made, m
  Eigen::Vector3d start_rpy = Eigen::Vector3d::Zero();           // rad
  Swing surge, sway, heave, roll, pitch, yaw;
  double draft_rate = 0.0;      // m/s, sinks
  Run ebb;                      // the water falls, and the ship with it
  std::vector<Course> courses;  // in order of time
};

/// When the ship first leaves her place along or off the quay; nullopt: never.
[[nodiscard]] std::optional<double> under_way(const HullMotionConfig& motion);

struct ShipPose {
  Eigen::Vector3d displacement;  // of the reference point, m
  Eigen::Vector3d rpy;           // rad
};

class HullMotion {
 public:
  HullMotion(const HullMotionConfig& config, const Eigen::Vector3d& reference_point_H, std::uint64_t seed);

  [[nodiscard]] ShipPose pose(double t) const;
  [[nodiscard]] Pose T_W_H(double t) const;
  /// How far the water has fallen since time 0, m.
  [[nodiscard]] double ebb(double t) const;
  /// T_W_H of such a pose about the reference point.
  [[nodiscard]] Pose transform(const ShipPose& pose) const;
  [[nodiscard]] const HullMotionConfig& config() const { return config_; }
  [[nodiscard]] const Eigen::Vector3d& reference_point() const { return reference_point_H_; }

 private:
  static constexpr int kSines = 4;
  struct Wave {
    double amplitude, angular_frequency, phase;
  };
  using Waves = std::array<Wave, kSines>;
  static Waves waves(const Swing& swing, std::uint64_t seed, std::uint64_t stream);

  HullMotionConfig config_;
  Eigen::Vector3d reference_point_H_;
  std::array<Waves, 6> waves_;  // surge, sway, heave, roll, pitch, yaw
};

/// Distance covered by `run` at time t, m.
[[nodiscard]] double run_distance(const Run& run, double t);

}  // namespace hulltrack
