// Can a LiDAR's own clock be believed? How far it is off this host's, how fast it drifts away, and what a
// clock that is off by so much is likely to run on.
//
// A datagram is stamped some tenths of a millisecond after its last firing, later where host or network are
// busy, never earlier. So of many datagrams the largest difference "sensor minus host" is nearest to the
// truth: one is kept a second, and the drift is the slope of a minute of them.
// Offsets are taken modulo the sensor's wrap. Thread rule: one owner. Cost: a few ns a datagram.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "core/base/time.hpp"
#include "lidar_drivers/decoder.hpp"

namespace hulltrack {

/// How a sensor's clock stands against the host's.
struct ClockReading {
  Nanoseconds offset{};  // sensor minus host modulo `wrap`, the best of the last second
  std::optional<double>
      drift{};         // s/s, what the sensor's clock gains; nothing until ten seconds have been seen
  Nanoseconds time{};  // the sensor's, newest
  Nanoseconds wrap{};  // as Decoder::clock_wrap()
  ClockReference reference = ClockReference::unknown;

  /// Near enough to be used, and not by chance: makers state 90 ppm for a clock that follows nothing, so that
  /// it drifts through the tolerance from end to end within some seven minutes.
  [[nodiscard]] bool believed() const;
};

/// An offset as one reads it, to a tenth of its unit: "3.2 ms behind", "37.0 s ahead", "56.0 years behind".
[[nodiscard]] std::string offset_words(Nanoseconds sensor_minus_host);

/// For log and probe, to follow "its clock is": offset and drift, what it is likely to run on where it is
/// off, what the sensor says of it. "37.0 s ahead of this computer's and gains 3.1 ppm: it runs on TAI, as
/// PTP does, not on UTC; the sensor says that it follows PTP".
[[nodiscard]] std::string clock_words(const ClockReading& reading);

class SensorClock {
 public:
  /// A clock farther off is not believed: at 0.3 m/s of a boom's tip it would shift points by 6 mm.
  static constexpr Nanoseconds kTolerance = std::chrono::milliseconds(20);

  /// `wrap` as Decoder::clock_wrap(): zero = it never starts again.
  explicit SensorClock(Nanoseconds wrap) : wrap_(wrap) {}

  /// Of one datagram: `sensor` its clock at the last firing, [0, 2^62) ns, `host` when it was received,
  /// `reference` what the sensor says of its clock. Gives sensor minus host.
  Nanoseconds note(Nanoseconds sensor, WallTime host, ClockReference reference = ClockReference::unknown);

  /// Sensor minus host, the best of the last second; zero before the first datagram.
  [[nodiscard]] Nanoseconds offset() const { return best_ ? *best_ : Nanoseconds{0}; }
  [[nodiscard]] bool believed() const {
    return ClockReading{.offset = offset(), .reference = reference_}.believed();
  }
  /// Seconds that the sensor's clock gains in a second; nothing until ten seconds have been seen.
  [[nodiscard]] std::optional<double> drift() const;
  [[nodiscard]] ClockReading reading() const {
    return {offset(), drift(), newest_sensor_, wrap_, reference_};
  }

 private:
  static constexpr std::size_t kSeconds = 60;
  struct Second {
    WallTime time;
    Nanoseconds offset;
  };

  Nanoseconds wrap_;
  Nanoseconds newest_sensor_{};
  ClockReference reference_ = ClockReference::unknown;  // newest
  WallTime second_began_{};
  std::optional<Nanoseconds> best_;    // of the second before, until this one has a datagram more
  std::optional<Nanoseconds> so_far_;  // of this second
  std::array<Second, kSeconds> seconds_{};
  std::size_t count_ = 0;  // ever written since the clock jumped last
};

}  // namespace hulltrack
