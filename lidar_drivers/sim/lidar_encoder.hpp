// The inverse of a decoder: which rays a datagram fires, and ranges -> its bytes.
//
// Use: for each datagram n = 0, 1, 2, ... ask firings(n), cast one ray a firing at its own time, then
// encode(n, returns). A firing leaves L at `origin` along `direction`; the return lies at
// origin + range * direction, which is what the decoder gives back to within the format's resolution.
// Time counts from 0 at the first firing of datagram 0. Thread rule: const calls from any thread at once.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "lidar_drivers/decoder.hpp"

namespace hulltrack::sim {

struct LidarEncoderConfig {
  ReturnMode return_mode = ReturnMode::strongest;  // strongest, last, dual
  double rpm = 600.0;                              // of a rotating sensor; the model's header says its range
  double start_azimuth = 0.0;                      // rad, rotor at time 0, clockwise seen from above
  Nanoseconds utc{};                               // the sensor's clock at time 0, since 1970
};

/// One laser pulse as it really leaves the sensor.
struct LaserFiring {
  Nanoseconds time;           // since the first firing of datagram 0
  double azimuth;             // rad, clockwise from +x seen from above, the laser's own offset included
  double elevation;           // rad
  Eigen::Vector3d origin;     // m in L
  Eigen::Vector3d direction;  // unit, in L
  std::uint8_t channel;       // laser, 0-based
};

struct LaserReturn {
  double range = 0.0;  // m; anything that the format cannot hold, 0 included, is encoded as "no return"
  std::uint8_t intensity = 0;
};

/// What goes with the data: a file that the decoder needs, or a datagram that the sensor sends about itself.
struct SensorInformation {
  std::string calibration_name;        // file name; empty = none is needed
  std::string calibration;             // its content
  std::vector<std::uint8_t> datagram;  // sent once a second to the model's information port; empty = none
};

class LidarEncoder {
 public:
  LidarEncoder() = default;
  virtual ~LidarEncoder() = default;

  /// Pulses of one datagram.
  [[nodiscard]] virtual std::size_t firings_per_packet() const = 0;
  /// From the first firing of one datagram to that of the next.
  [[nodiscard]] virtual Nanoseconds packet_interval() const = 0;
  /// From the first to the last firing of one datagram: add it to first_firing(n) for the receive stamp.
  [[nodiscard]] virtual Nanoseconds packet_duration() const = 0;
  [[nodiscard]] Nanoseconds first_firing(std::uint64_t packet) const {
    return static_cast<Nanoseconds::rep>(packet) * packet_interval();
  }
  [[nodiscard]] Nanoseconds last_firing(std::uint64_t packet) const {
    return first_firing(packet) + packet_duration();
  }

  /// Replaces `out` by the packet's firings in wire order; the front one is the earliest, the back one the
  /// latest.
  virtual void firings(std::uint64_t packet, std::vector<LaserFiring>& out) const = 0;

  /// `returns` belongs to firings(packet) one to one; with dual return two a firing: [2i] the last
  /// return, [2i + 1] the strongest (the second strongest where the last is the strongest; the same again
  /// where there is only one). Precondition: its size fits.
  [[nodiscard]] virtual std::vector<std::uint8_t> encode(std::uint64_t packet,
                                                         std::span<const LaserReturn> returns) const = 0;

  [[nodiscard]] virtual SensorInformation information() const { return {}; }

 protected:
  LidarEncoder(const LidarEncoder&) = default;
  LidarEncoder& operator=(const LidarEncoder&) = default;
};

}  // namespace hulltrack::sim
