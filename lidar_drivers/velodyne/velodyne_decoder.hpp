// Velodyne VLP-16, Puck Hi-Res, HDL-32E and VLP-32C: one data packet -> points in L.
//
// L: x = d cos(el) cos(az), y = -d cos(el) sin(az), z = d sin(el) + vertical offset. The manual draws y
// forward and x right; azimuth counts clockwise from forward, so L's x is the manual's y, L's y its -x.
// Between two blocks azimuth runs evenly; the last block goes on as the one before. Where a step does not
// fit the rotation (the sensor leaves a sector out) nothing is interpolated across and the time of the jump
// is taken from the rotation rate. Single and dual return are told apart packet by packet.
#pragma once

#include <array>

#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/velodyne/velodyne_format.hpp"

namespace hulltrack::velodyne {

class VelodyneDecoder final : public Decoder {
 public:
  /// `model` from models(): it must outlive the decoder.
  VelodyneDecoder(const ModelTable& model, const DecoderOptions& options);

  [[nodiscard]] DecodeOutcome decode(std::span<const std::uint8_t> payload,
                                     DecodedPacket& out) const override;
  [[nodiscard]] std::string explain(const DecodeOutcome& outcome) const override;
  [[nodiscard]] Nanoseconds clock_wrap() const override { return kClockWrap; }

 private:
  /// What the lasers' tables come to, ready for the inner loop.
  struct Beam {
    double forward, left, up;   // unit vector in L at azimuth 0
    double vertical_offset;     // m, 0 when switched off
    double fraction_of_period;  // of the block's azimuth step, 0 when firing correction is off
  };
  struct Rotation;

  [[nodiscard]] DecodeOutcome check(std::span<const std::uint8_t> payload) const;
  [[nodiscard]] DecodeOutcome read_rotation(std::span<const std::uint8_t> payload, Rotation& rotation) const;
  void emit_block(std::span<const std::uint8_t> payload, std::size_t block, const Rotation& rotation,
                  DecodedPacket& out) const;

  const ModelTable& model_;
  DecoderOptions options_;
  std::array<Beam, kSlots> beams_;
};

}  // namespace hulltrack::velodyne
