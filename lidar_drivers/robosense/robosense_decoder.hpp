// RoboSense RS-LiDAR-16, -32, Helios 32, Helios 16P and Bpearl: one data packet -> points in L.
//
// L: x =  d cos(el) cos(h + dh) + lens cos(h), y = -d cos(el) sin(h + dh) - lens sin(h), z = d sin(el) + lens
// up. The maker's axes are those of L: x forward at zero azimuth, azimuth clockwise seen from above. el and
// dh are the unit's own, from its DIFOP packet; data before one is held back (awaiting_angles). h turns on
// evenly from block to block and is then truncated to 0.01 deg, as the maker's driver does: up to 17 mm at
// 100 m, and in the mean 0.005 deg of yaw, which the mount's calibration takes up. The last block, and one
// before a jump (a field of view set on the sensor), go on by the nominal step of the rotation rate. A jump
// may lie between the two firings of a block of a 16-laser model: the second firing's azimuth is not known
// then and its returns are left out. At the end of a datagram such a jump cannot be seen.
#pragma once

#include <array>
#include <optional>

#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/robosense/robosense_difop.hpp"
#include "lidar_drivers/robosense/robosense_format.hpp"

namespace hulltrack::robosense {

class RobosenseDecoder final : public Decoder {
 public:
  /// `model` from models(): it must outlive the decoder.
  RobosenseDecoder(const ModelTable& model, const DecoderOptions& options);

  [[nodiscard]] DecodeOutcome decode(std::span<const std::uint8_t> payload,
                                     DecodedPacket& out) const override;
  /// A unit of another model is taken in too, as far as can be told: its data are refused from then on.
  /// A unit's angles never change and its packet has no checksum: where two in a row differ, one was damaged
  /// on its way, the unit was exchanged, or two units send to one port. Data are held back then until two in
  /// a row agree.
  bool inform(std::span<const std::uint8_t> payload) override;
  /// The same of a DIFOP packet that was read already.
  void inform(const Difop& unit);
  [[nodiscard]] std::string explain(const DecodeOutcome& outcome) const override;
  [[nodiscard]] Nanoseconds clock_wrap() const override { return Nanoseconds::zero(); }

 private:
  /// A laser's angles, ready for the inner loop: its unit vector in L at azimuth 0.
  struct Beam {
    double forward, left, up;
  };
  struct Rotation;

  [[nodiscard]] DecodeOutcome check(std::span<const std::uint8_t> payload) const;
  [[nodiscard]] DecodeOutcome read_rotation(std::span<const std::uint8_t> payload, Rotation& rotation) const;
  [[nodiscard]] DecodeOutcome find_jumps(Rotation& rotation) const;
  void emit_block(std::span<const std::uint8_t> payload, std::size_t block, const Rotation& rotation,
                  DecodedPacket& out) const;

  const ModelTable& model_;
  DecoderOptions options_;
  Nanoseconds last_pulse_{};   // of a firing, after its first
  std::optional<Difop> told_;  // by the newest packet
  std::optional<Difop> unit_;  // the same, unless the packet before contradicts it
  std::array<Beam, kSlots> beams_{};
};

}  // namespace hulltrack::robosense
