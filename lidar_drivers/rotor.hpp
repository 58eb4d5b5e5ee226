// How far did a rotor turn from block to block of a datagram? What Velodyne's, Hesai's and RoboSense's
// formats have in common.
//
// Azimuths and steps in 0.01 deg, azimuths in [0, 36000). A sensor that leaves a sector out makes the azimuth
// jump: such a step is none of the rotation's, and its time follows from the rate. Pure functions.
#pragma once

#include <optional>
#include <span>

#include "core/base/time.hpp"

namespace hulltrack::rotor {

inline constexpr int kCentidegrees = 36000;  // one turn
/// A turn slower than any model's lowest setting (300 rpm) tells nothing about how long a jump took.
inline constexpr double kMinRpmToTimeJumps = 200.0;

/// [-10, 36000 - 10): a rotor that stands still may seem to come back by a little.
[[nodiscard]] int forward_step(int from, int to);

/// Marks in `jump` the steps that do not fit the expected one, to half of it or 0.03 deg; gives the mean of
/// the others, >= 0, or nothing if there are none. Precondition: `jump` is not shorter than `steps`.
[[nodiscard]] std::optional<double> fit_steps(std::span<const int> steps, double expected,
                                              std::span<bool> jump);

/// How long a step took, to the next block: one period, a jump as long as the rotor turns for it at `rate` (a
/// period), which has to be known.
[[nodiscard]] Nanoseconds duration_of(int step, bool jump, double rate, bool rate_known, Nanoseconds period);

/// When a rotor that turns on from `azimuth` by `step` within `span` passes zero, after its begin.
[[nodiscard]] std::optional<Nanoseconds> time_to_zero(double azimuth, double step, Nanoseconds span);

}  // namespace hulltrack::rotor
