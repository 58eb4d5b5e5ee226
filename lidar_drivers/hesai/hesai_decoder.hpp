// Hesai PandarXT, Pandar40P, Pandar64, PandarQT: one data datagram -> points in L.
//
// L: x = d cos(el) cos(az), y = -d cos(el) sin(az), z = d sin(el). The manuals draw y forward and x right;
// azimuth counts clockwise from forward, so L's x is the manual's y, L's y its -x. The azimuth of a point is
// its block's, plus its laser's offset, plus what the rotor turns until the laser fires.
// Of several returns of a firing the farthest is the last one (echo 0), wherever it stands: firmwares order
// the blocks of a firing differently. One at the distance of a block before it is the same return again.
// A date that is none, or wrong, changes nothing but sensor_time (hesai_clock.hpp). The optical centre, a
// few millimetres beside the axis, is taken as on it.
#pragma once

#include <array>
#include <span>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"
#include "lidar_drivers/hesai/hesai_rotation.hpp"

namespace hulltrack::hesai {

class HesaiDecoder final : public Decoder {
 public:
  /// `model` from models(): it must outlive the decoder. Precondition: `angles` has one entry a laser.
  HesaiDecoder(const ModelTable& model, std::span<const LaserAngles> angles, const DecoderOptions& options);

  [[nodiscard]] DecodeOutcome decode(std::span<const std::uint8_t> payload,
                                     DecodedPacket& out) const override;
  [[nodiscard]] std::string explain(const DecodeOutcome& outcome) const override;
  [[nodiscard]] Nanoseconds clock_wrap() const override { return Nanoseconds::zero(); }

 private:
  /// Unit vector in L of a laser.
  struct Beam {
    double forward, left, up;
  };
  using Beams = std::array<Beam, kMaxLasers>;
  /// What one datagram's blocks have in common.
  struct Datagram {
    Bytes bytes;
    std::size_t returns;      // blocks a firing
    double distance_unit;     // m
    Nanoseconds last_firing;  // after the first group's reference
    Rotation rotation;
  };

  [[nodiscard]] DecodeOutcome check(Bytes payload) const;
  [[nodiscard]] DecodeOutcome check_header(Bytes payload) const;
  /// What the header says the datagram has; where nothing does, `payload`'s own if it is a possible one.
  [[nodiscard]] std::size_t stated_size(Bytes payload) const;
  [[nodiscard]] std::size_t returns(Bytes payload) const;  // a firing; 0 = a mode that the model has not
  [[nodiscard]] double distance_unit(Bytes payload) const;
  [[nodiscard]] DecodeOutcome read_azimuths(Datagram& datagram) const;
  [[nodiscard]] std::optional<PacketCounter> counter(Bytes payload) const;
  [[nodiscard]] Beams beams_at(double rate) const;
  void emit_block(const Datagram& datagram, std::size_t block, const Beams& beams, DecodedPacket& out) const;

  const ModelTable& model_;
  DecoderOptions options_;
  std::array<LaserAngles, kMaxLasers> angles_;
  Nanoseconds first_pulse_, last_pulse_;  // of a block, after its reference
};

}  // namespace hulltrack::hesai
