// How the rotor moved during one data packet. A group is a block, or one pair of blocks with two echoes.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.hpp"
#include "lidar_drivers/robosense/robosense_decoder.hpp"

namespace hulltrack::robosense {

struct RobosenseDecoder::Rotation {
  bool dual = false;
  std::size_t groups = kBlocks;
  std::size_t blocks_per_group = 1;
  bool two_firings = false;  // in every block
  Nanoseconds span{};        // from one group to the next
  Nanoseconds last_pulse{};  // of a group, after its first

  std::array<int, kBlocks> azimuth{};  // 0.01 deg at the group's first firing
  std::array<int, kBlocks> step{};     // to the next group as reported, 0.01 deg; the last group has none
  std::array<bool, kBlocks> jump{};    // the step does not fit the rotation
  std::array<int, kBlocks> advance{};  // by which azimuth turns within `span`, 0.01 deg
  std::array<Nanoseconds, kBlocks> time{};  // of the group's first firing, after the packet's first
  double rate = 0.0;                        // 0.01 deg in `span`
  Nanoseconds duration{};                   // first to last firing

  [[nodiscard]] int median_step() const;
  /// 0.01 deg in `span` at a rotation rate, one that is not whole included.
  [[nodiscard]] double step_at(double rpm) const { return rpm / 60.0 * kCentidegrees * to_seconds(span); }
};

}  // namespace hulltrack::robosense
