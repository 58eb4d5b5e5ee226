// The two kinds of time, as two types that do not convert by accident.
//
// MeasurementTime orders measurements: points, joint samples, frames. Live it counts nanoseconds of
// the monotonic clock (kernel stamps are converted on reception); in a recording, UTC nanoseconds of
// the capture. Nothing that measures uses anything else.
// SteadyTime decides time-outs and ages: CLOCK_MONOTONIC, never a recording's clock.
// Core code is handed times; it asks no clock.
#pragma once

#include <chrono>
#include <cstdint>

namespace hulltrack {

using Nanoseconds = std::chrono::nanoseconds;

struct MeasurementClock {
  using duration = Nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<MeasurementClock>;
  static constexpr bool is_steady = true;
};

using MeasurementTime = MeasurementClock::time_point;
using SteadyTime = std::chrono::time_point<std::chrono::steady_clock, Nanoseconds>;

/// Wall clock (UTC): the kernel stamps datagrams with it, and sensors count it. It is converted to
/// MeasurementTime at the edge; nothing that measures or waits uses it.
using WallTime = std::chrono::time_point<std::chrono::system_clock, Nanoseconds>;

[[nodiscard]] constexpr MeasurementTime measurement_time_from_ns(std::int64_t ns) {
  return MeasurementTime{Nanoseconds{ns}};
}
[[nodiscard]] constexpr std::int64_t to_ns(MeasurementTime t) { return t.time_since_epoch().count(); }

/// Seconds as double: for rates and displays, not for storing times.
[[nodiscard]] constexpr double to_seconds(Nanoseconds d) { return static_cast<double>(d.count()) * 1e-9; }
[[nodiscard]] constexpr double to_milliseconds(Nanoseconds d) {
  return static_cast<double>(d.count()) * 1e-6;
}
/// From milliseconds as a configuration gives them. |ms| must be below 9.2e12 (292 years).
[[nodiscard]] constexpr Nanoseconds nanoseconds_from_ms(double ms) {
  return Nanoseconds{static_cast<std::int64_t>(ms * 1e6)};
}

}  // namespace hulltrack
