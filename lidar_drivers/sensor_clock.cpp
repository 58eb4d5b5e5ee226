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
constexpr Nanoseconds kQuarter = std::chrono::minutes(15);  // time zones are multiples of it

/// Sensor minus host, both modulo `wrap` (zero = none), as the smallest difference.
Nanoseconds difference(Nanoseconds sensor, WallTime host, Nanoseconds wrap) {
  if (wrap == Nanoseconds::zero()) return sensor - host.time_since_epoch();
  const Nanoseconds d = (sensor - host.time_since_epoch() % wrap) % wrap;
  if (d > wrap / 2) return d - wrap;
  if (d < -wrap / 2) return d + wrap;
  return d;
}

bool is_near(Nanoseconds a, Nanoseconds b) { return std::chrono::abs(a - b) <= SensorClock::kTolerance; }

}  // namespace

Nanoseconds SensorClock::note(Nanoseconds sensor, WallTime host) {
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

std::string SensorClock::suspicion() const {
  if (believed()) return {};
  const Nanoseconds off = offset();
  if (is_near(off, kTaiMinusUtc)) return "37 s ahead: it runs on TAI, as PTP does, not on UTC";
  if (is_near(off, kGpsMinusUtc)) return "18 s ahead: it runs on GPS time, not on UTC";
  if (is_near(std::chrono::abs(off), kSecond)) return "1 s apart: one of the two has missed a leap second";
  if (wrap_ == Nanoseconds::zero() && newest_sensor_ < kNeverSet)
    return format_text("never set: it has counted %.0f s since it was switched on, or since 1970",
                       to_seconds(newest_sensor_));
  const Nanoseconds zone = (std::chrono::abs(off) + kQuarter / 2) / kQuarter * kQuarter;
  if (wrap_ == Nanoseconds::zero() && zone <= std::chrono::hours(14) && is_near(std::chrono::abs(off), zone))
    return format_text("%.2f h %s: it keeps the time of another zone", to_seconds(zone) / 3600.0,
                       off > Nanoseconds::zero() ? "ahead" : "behind");
  if (wrap_ == Nanoseconds::zero())
    return format_text("%.3f s %s this computer's", std::abs(to_seconds(off)),
                       off > Nanoseconds::zero() ? "ahead of" : "behind");
  return format_text("%.3f s %s this computer's in the %.0f min that it counts: it is not synchronised",
                     std::abs(to_seconds(off)), off > Nanoseconds::zero() ? "ahead of" : "behind",
                     to_seconds(wrap_) / 60.0);
}

}  // namespace hulltrack
