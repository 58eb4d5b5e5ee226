// The inverse of the Ouster decoder: an OS-1-64 at 1024 columns a turn, with a nominal table of beams.
//
// Profile RNG19_RFL8_SIG16_NIR16, with two returns its DUAL: 1 mm of range is what the format resolves;
// angles and times are exact. 1024 firings a datagram of 16 columns. rpm: 600 or 1200, the two modes of 1024
// columns. start_azimuth is taken down to a whole datagram (5.6 deg). Return modes: strongest, dual. The
// decoder needs information().calibration, the metadata.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "lidar_drivers/ouster/ouster_metadata.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack::sim {

class OusterEncoder final : public LidarEncoder {
 public:
  /// `model` is "ouster_os". An error says what an Ouster cannot be set to.
  [[nodiscard]] static Result<OusterEncoder> create(std::string_view model, const LidarEncoderConfig& config);

  [[nodiscard]] std::size_t firings_per_packet() const override;
  [[nodiscard]] Nanoseconds packet_interval() const override;
  [[nodiscard]] Nanoseconds packet_duration() const override;
  void firings(std::uint64_t packet, std::vector<LaserFiring>& out) const override;
  [[nodiscard]] std::vector<std::uint8_t> encode(std::uint64_t packet,
                                                 std::span<const LaserReturn> returns) const override;
  [[nodiscard]] SensorInformation information() const override;

 private:
  OusterEncoder(ouster::Metadata metadata, const LidarEncoderConfig& config);
  [[nodiscard]] std::uint64_t packets_per_frame() const;
  /// Of the whole run, as if the sensor had been started at measurement 0 of frame 0.
  [[nodiscard]] std::uint64_t index_of(std::uint64_t packet) const { return packet + first_index_; }
  [[nodiscard]] int measurement_id(std::uint64_t packet, std::size_t column) const;
  [[nodiscard]] Nanoseconds column_time(std::size_t column) const;  // after the datagram's first

  ouster::Metadata metadata_;
  LidarEncoderConfig config_;
  std::uint64_t first_index_;
};

}  // namespace hulltrack::sim
