// Ouster OS-0, OS-1 and OS-2: one lidar datagram -> points in L.
//
// L is the manual's Sensor frame: x away from the connector, z up, lidar_to_sensor_transform applied. It is
// ours already (x forward, y left, z up). The rotor's azimuth is 2 pi m / W, clockwise seen from above; its
// zero, where frame_id changes, is over the connector: L's -x. A point is where its column was measured
// (staggered): the measurement id sets the angle, the beam's own azimuth is added. All beams of a column
// share one time, so there is no firing correction to switch. A range is counted from the lidar origin along
// the beam's way, of which the first n mm turn with the rotor. Dual return: the datagram has the stronger
// echo first; that of the larger range is the last one, echo 0. Two at the same range are one echo. Single
// return says the strongest. Cost: a datagram of 2048 returns takes some 15 us.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/ouster/ouster_metadata.hpp"

namespace hulltrack::ouster {

class OusterDecoder final : public Decoder {
 public:
  OusterDecoder(const Metadata& metadata, const DecoderOptions& options);

  /// wrong_layout: the datagram is none of the lidar's (expected, seen: packet_type); wrong_product: the
  /// metadata is another sensor's (low 32 bits of the serial numbers); bad_azimuth: a measurement id beyond
  /// the frame or not larger than the one before (expected: columns a frame; seen: the id).
  /// Columns that are marked invalid yield no point; one without any other is dated by all its columns.
  [[nodiscard]] DecodeOutcome decode(std::span<const std::uint8_t> payload,
                                     DecodedPacket& out) const override;
  /// The IMU's datagrams, where a site gives lidar and IMU one port.
  bool inform(std::span<const std::uint8_t> payload) override { return payload.size() == kImuPacketBytes; }
  [[nodiscard]] std::string explain(const DecodeOutcome& outcome) const override;
  [[nodiscard]] Nanoseconds clock_wrap() const override { return Nanoseconds::zero(); }

 private:
  /// Unit vector in the lidar frame at th_e = 0.
  struct Direction {
    double x, y, z;
  };
  struct Angle {
    double cos, sin;
  };
  struct Columns;

  [[nodiscard]] DecodeOutcome check(std::span<const std::uint8_t> payload) const;
  [[nodiscard]] DecodeOutcome read_columns(std::span<const std::uint8_t> payload, Columns& columns) const;
  void tell_rotation(std::span<const std::uint8_t> payload, const Columns& columns, DecodedPacket& out) const;
  [[nodiscard]] std::optional<PacketCounter> counter(std::span<const std::uint8_t> payload,
                                                     const Columns& columns) const;
  template <typename Pixel>
  void emit(std::span<const std::uint8_t> payload, const Columns& columns, DecodedPacket& out) const;

  Metadata metadata_;
  DecoderOptions options_;
  std::vector<Direction> beams_;  // by pixel row
  std::vector<Angle> angles_;     // th_e by measurement id
  /// Which datagram of a frame has the columns from i * columns_per_packet on; -1: the window leaves it out.
  std::vector<int> packet_of_frame_;
  int packets_per_frame_ = 0;
};

}  // namespace hulltrack::ouster
