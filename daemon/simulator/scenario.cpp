#include "daemon/simulator/scenario.hpp"

#include <algorithm>
#include <limits>

namespace hulltrack {
namespace {

constexpr double kPerHour = 1.0 / 3600.0;
constexpr double kFramePeriod = 0.1;  // s
constexpr double kForEver = std::numeric_limits<double>::infinity();

/// A river berth out of the swell: the low end of what sheltered berths see.
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

/// Long waves and passing ships at the upper end of a sheltered berth's range.
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

HullMotionConfig departing() {
  HullMotionConfig motion = sheltered();
  constexpr int kDepartureFrame = 800;                    // Guo 2025, 3.1
  motion.run_direction = Eigen::Vector3d(0.8, 0.6, 0.0);  // ahead and off the quay
  motion.run = {kDepartureFrame * kFramePeriod, 1.5, 0.08, kForEver};
  motion.run_yaw_rate = radians(0.3);
  return motion;
}

HullMotionConfig still() { return {}; }

/// Hours of loading since the map was made: deeper, down by the stern, heeled towards the quay.
HullMotionConfig loaded() {
  HullMotionConfig motion = sheltered();
  motion.draft_rate = 1.3 * kPerHour;
  motion.start_displacement = {0.05, -0.03, -0.60};
  motion.start_rpy = {radians(0.50), radians(-0.30), radians(0.02)};
  return motion;
}

/// The ship is warped along the quay to the next hatch.
HullMotionConfig warping() {
  HullMotionConfig motion = sheltered();
  constexpr double kHatchPitch = 22.6;  // m, second to third hatch of berth_ship()
  motion.run = {30.0, 0.2, 0.02, kHatchPitch};
  return motion;
}

std::vector<Scenario> make_scenarios() {
  return {
      {"berth",
       "The paper's test: quietly moored in a sheltered river berth while loading, departs at frame 800.",
       869, departing(), berth_ship(), 0.35},
      {"static", "The hull lies still, exactly where the map was made; only the loader moves.", 300, still(),
       berth_ship(), 0.0},
      {"mooring", "The ship ranges at its lines: surge 0.3 m, sway 0.2 m, roll half a degree.", 1800,
       uneasy(), berth_ship(), 0.35},
      {"draft", "Well into loading: 0.6 m deeper than in the map, trimmed and heeled, still sinking 1.3 m/h.",
       1800, loaded(), berth_ship(), 0.8},
      {"shift", "After 30 s the ship is warped along the quay by one hatch at 0.2 m/s.", 1800, warping(),
       berth_ship(), 0.35},
      {"wrong-ship", "Another ship of the same trade lies at the berth than the one in the map.", 300,
       sheltered(), stranger_ship(), 0.35},
  };
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = make_scenarios();
  return all;
}

const Scenario* find_scenario(std::string_view name) {
  const auto found =
      std::find_if(scenarios().begin(), scenarios().end(), [&](const Scenario& s) { return s.name == name; });
  return found == scenarios().end() ? nullptr : &*found;
}

}  // namespace hulltrack
