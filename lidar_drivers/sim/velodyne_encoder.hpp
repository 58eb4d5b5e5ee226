// The inverse of the Velodyne decoder: which rays a datagram fires, and ranges -> its 1206 bytes.
//
// Use: for each datagram n = 0, 1, 2, ... ask firings(n), cast one ray a firing at its own time, then
// encode(n, returns). A firing leaves L at (0, 0, origin_z) along `direction`; the return lies at
// origin + range * direction, which is what the decoder gives back to within the format's resolution
// (0.01 deg of azimuth, one distance unit).
// Time counts from 0 at the first firing of datagram 0. Thread rule: const calls from any thread at once.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/velodyne/velodyne_format.hpp"

namespace hulltrack::sim {

struct VelodyneEncoderConfig {
  ReturnMode return_mode = ReturnMode::strongest;  // strongest, last, dual
  double rpm = 600.0;                              // (0, 1500]
  double start_azimuth = 0.0;                      // rad, rotor at time 0, clockwise seen from above
  Nanoseconds time_of_hour{};                      // the sensor's clock at time 0, [0, 1 h)
};

/// One laser pulse as it really leaves the sensor.
struct VelodyneFiring {
  Nanoseconds time;           // since the first firing of datagram 0
  double azimuth;             // rad, clockwise from +x seen from above, the laser's own offset included
  double elevation;           // rad
  double origin_z;            // m in L
  Eigen::Vector3d direction;  // unit, in L
  std::uint8_t channel;       // laser, 0-based
};

struct VelodyneReturn {
  double range = 0.0;  // m; anything that the format cannot hold, 0 included, is encoded as "no return"
  std::uint8_t intensity = 0;
};

class VelodyneEncoder {
 public:
  /// `model` is a velodyne_* name of the model registry; an unknown one, or a rate out of range, is an error.
  [[nodiscard]] static Result<VelodyneEncoder> create(std::string_view model,
                                                      const VelodyneEncoderConfig& config);

  /// Firings of one datagram: 384 with a single return, 192 with two.
  [[nodiscard]] std::size_t firings_per_packet() const;
  /// From the first firing of one datagram to that of the next.
  [[nodiscard]] Nanoseconds packet_interval() const;
  /// From the first to the last firing of one datagram: add it to first_firing(n) for the receive stamp.
  [[nodiscard]] Nanoseconds packet_duration() const;
  [[nodiscard]] Nanoseconds first_firing(std::uint64_t packet) const;
  [[nodiscard]] Nanoseconds last_firing(std::uint64_t packet) const;

  /// Replaces `out` by the packet's firings in wire order, which is also order of time.
  void firings(std::uint64_t packet, std::vector<VelodyneFiring>& out) const;

  /// `returns` belongs to firings(packet) one to one; with dual return two a firing: [2i] the last
  /// return, [2i + 1] the strongest (the second strongest where the last is the strongest; the same again
  /// where there is only one). Precondition: its size fits.
  [[nodiscard]] std::array<std::uint8_t, velodyne::kPacketBytes> encode(
      std::uint64_t packet, std::span<const VelodyneReturn> returns) const;

 private:
  VelodyneEncoder(const velodyne::ModelTable& model, const VelodyneEncoderConfig& config);
  [[nodiscard]] double rotor_azimuth(Nanoseconds time) const;  // deg, [0, 360)
  [[nodiscard]] int groups() const;                            // firing groups a datagram: 12, dual 6

  const velodyne::ModelTable* model_;
  VelodyneEncoderConfig config_;
};

}  // namespace hulltrack::sim
