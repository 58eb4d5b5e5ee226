// The live service's link between the two kinds of time: both count nanoseconds of CLOCK_MONOTONIC.
//
// Only the service may convert; in a replay the clocks have nothing to do with each other. Pure, but for
// steady_now(), the one place where the service asks a clock.
#pragma once

#include <chrono>

#include "core/base/time.hpp"

namespace hulltrack {

[[nodiscard]] inline SteadyTime steady_now() { return std::chrono::steady_clock::now(); }

[[nodiscard]] constexpr MeasurementTime live_measurement_time(SteadyTime t) {
  return MeasurementTime{t.time_since_epoch()};
}
[[nodiscard]] constexpr SteadyTime live_steady_time(MeasurementTime t) {
  return SteadyTime{t.time_since_epoch()};
}

}  // namespace hulltrack
