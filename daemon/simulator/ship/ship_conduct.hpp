// What do ships at a berth do? The motions that scenarios are made of.
//
// Magnitudes and their sources: hulltrack(1), section SIMULATE. Seconds from the first firing, metres,
// radians. Pure; nothing fails.
#pragma once

#include "daemon/simulator/ship/hull_motion.hpp"

namespace hulltrack::conduct {

inline constexpr double kHatchPitch = 22.6;  // m, second to third hatch of berth_ship()

/// A river berth out of the swell: the low end of what sheltered berths see; sinking 1 m/h.
[[nodiscard]] HullMotionConfig sheltered();

/// Long waves and passing ships at the upper end of a sheltered berth's range.
[[nodiscard]] HullMotionConfig uneasy();

/// Sheltered, hours of loading after the map was made: deeper, down by the stern, heeled towards the quay.
[[nodiscard]] HullMotionConfig loaded();

/// Uneasy, and 7 m deeper within 142 s: by cargo and by the ebb.
[[nodiscard]] HullMotionConfig sinking();

/// Uneasy, with what a whole shift brings in five minutes: cargo, ebb, list one way and the other, trim.
[[nodiscard]] HullMotionConfig whole_shift();

/// `motion` and then what the ship does beside it.
[[nodiscard]] HullMotionConfig with(HullMotionConfig motion, const std::vector<Course>& courses);

/// Displaced by `way` (W, m) with this speed and acceleration, from `start` on.
[[nodiscard]] Course shifted(double start, const Eigen::Vector3d& way, double speed, double acceleration);

/// The same without an end, along `direction` (unit).
[[nodiscard]] Course leaving(double start, const Eigen::Vector3d& direction, double speed,
                             double acceleration, double yaw_rate);

/// Turned by `rpy` (rad, small) from `start` on within `duration` > 8 s, four of them to speed up and four to
/// slow down.
[[nodiscard]] Course listing(double start, double duration, const Eigen::Vector3d& rpy);

}  // namespace hulltrack::conduct
