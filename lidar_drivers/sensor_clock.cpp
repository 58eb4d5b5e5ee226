#include "lidar_drivers/sensor_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/text.hpp"

namespace hulltrack {

namespace {

constexpr Nanoseconds kSecond = std::chrono::seconds(1);
/// Farther from the second before than this no crystal drifts (100 ppm): the clock was set.
constexpr Nanoseconds kJump = std::chrono::milliseconds(5);
constexpr std::size_t kFewestForDrift = 10;
/// Until then a clock that was never set counts from 1970, or from when it was switched on.
constexpr Nanoseconds kNeverSet = std::chrono::hours(24 * 365);
/// TAI is ahead of UTC by as much since 2017, GPS time by 18 s.
constexpr Nanoseconds kTaiMinusUtc = std::chrono::seconds(37);
constexpr Nanoseconds kGpsMinusUtc = std::chrono::seconds(18);
constexpr Nanoseconds kQuarter = std::chrono::minutes(15);      // time zones are multiples of it
constexpr Nanoseconds kFarthestZones = std::chrono::hours(14);  // from UTC

/// Sensor minus host, both modulo `wrap` (zero = none), as the smallest difference.
Nanoseconds difference(Nanoseconds sensor, WallTime host, Nanoseconds wrap) {
  if (wrap == Nanoseconds::zero()) return sensor - host.time_since_epoch();
  const Nanoseconds d = (sensor - host.time_since_epoch() % wrap) % wrap;
  if (d > wrap / 2) return d - wrap;
  if (d < -wrap / 2) return d + wrap;
  return d;
}

bool is_near(Nanoseconds a, Nanoseconds b) { return std::chrono::abs(a - b) <= SensorClock::kTolerance; }

/// In the largest unit of which it is more than two or so, to a tenth.
std::string duration_words(Nanoseconds size) {
  struct Unit {
    double seconds;
    const char* name;
    Nanoseconds from;
  };
  constexpr Unit kUnits[] = {{365.25 * 86'400.0, "years", std::chrono::hours(2 * 8766)},
                             {86'400.0, "days", std::chrono::hours(72)},
                             {3'600.0, "h", std::chrono::hours(3)},
                             {60.0, "min", std::chrono::minutes(10)},
                             {1.0, "s", std::chrono::seconds(1)},
                             {1e-3, "ms", Nanoseconds::zero()}};
  const Unit* unit =
      std::ranges::find_if(kUnits, [&](const Unit& candidate) { return size >= candidate.from; });
  return format_text("%.1f %s", to_seconds(size) / unit->seconds, unit->name);
}

/// What a clock that is off by so much is likely to run on, as ": ..."; empty where nothing is known.
std::string suspicion(const ClockReading& reading) {
  const Nanoseconds off = reading.offset;
  const Nanoseconds size = std::chrono::abs(off);
  if (is_near(off, kTaiMinusUtc)) return ": it runs on TAI, as PTP does, not on UTC";
  if (is_near(off, kGpsMinusUtc)) return ": it runs on GPS time, not on UTC";
  if (is_near(size, kSecond)) return ": one of the two has missed a leap second";
  if (reading.wrap > Nanoseconds::zero())
    return ": it is not synchronised in the " + duration_words(reading.wrap) + " that it counts";
  if (reading.time < kNeverSet)
    return ": it was never set, it has counted " + duration_words(reading.time) +
           " since it was switched on, or since 1970";
  const Nanoseconds zone = (size + kQuarter / 2) / kQuarter * kQuarter;
  if (zone <= kFarthestZones && is_near(size, zone)) return ": it keeps the time of another zone";
  return {};
}

const char* statement(ClockReference reference) {
  switch (reference) {
    case ClockReference::none:
      return "; the sensor says that it is not synchronised";
    case ClockReference::ptp:
      return "; the sensor says that it follows PTP";
    case ClockReference::gps:
      return "; the sensor says that it follows GPS";
    case ClockReference::pulse:
      return "; the sensor says that it follows a pulse without a date";
    case ClockReference::unknown:
      break;
  }
  return "";
}

}  // namespace

Nanoseconds SensorClock::note(Nanoseconds sensor, WallTime host, ClockReference reference) {
  const Nanoseconds offset = difference(sensor, host, wrap_);
  const Nanoseconds elapsed = host - second_began_;
  const bool jumped = best_ && std::chrono::abs(offset - *best_) > kTolerance + kJump;
  if (jumped || !best_) {
    count_ = 0;
    best_ = offset;
    so_far_ = offset;
    second_began_ = host;
  } else if (std::chrono::abs(elapsed) >= kSecond) {
    best_ = so_far_;
    seconds_[count_++ % kSeconds] = {second_began_, *best_};
    so_far_ = offset;
    second_began_ = host;
  } else {
    so_far_ = std::max(*so_far_, offset);
  }
  newest_sensor_ = sensor;
  reference_ = reference;
  return offset;
}

std::optional<double> SensorClock::drift() const {
  const std::size_t n = std::min(count_, kSeconds);
  if (n < kFewestForDrift) return std::nullopt;
  const Second& origin = seconds_[0];
  double t_mean = 0.0;
  double o_mean = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    t_mean += to_seconds(seconds_[i].time - origin.time) / static_cast<double>(n);
    o_mean += to_seconds(seconds_[i].offset - origin.offset) / static_cast<double>(n);
  }
  double tt = 0.0;
  double to = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = to_seconds(seconds_[i].time - origin.time) - t_mean;
    tt += t * t;
    to += t * (to_seconds(seconds_[i].offset - origin.offset) - o_mean);
  }
  return tt > 0.0 ? std::optional(to / tt) : std::nullopt;
}

bool ClockReading::believed() const {
  return reference != ClockReference::none && is_near(offset, Nanoseconds::zero());
}

std::string offset_words(Nanoseconds sensor_minus_host) {
  return duration_words(std::chrono::abs(sensor_minus_host)) +
         (sensor_minus_host > Nanoseconds::zero() ? " ahead" : " behind");
}

std::string clock_words(const ClockReading& reading) {
  std::string words = offset_words(reading.offset) +
                      (reading.offset > Nanoseconds::zero() ? " of this computer's" : " this computer's");
  if (reading.drift)
    words += format_text(" and %s %.1f ppm", *reading.drift < 0.0 ? "loses" : "gains",
                         1e6 * std::abs(*reading.drift));
  if (!is_near(reading.offset, Nanoseconds::zero())) words += suspicion(reading);
  return words + statement(reading.reference);
}

}  // namespace hulltrack
