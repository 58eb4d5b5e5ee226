// How the rotor moved during one datagram: from its blocks' azimuths and the motor speed that it states.
//
// A group is a block, or the blocks of one firing where it has several returns. Thread rule: a plain value.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/base/time.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"

namespace hulltrack::hesai {

struct Rotation {
  std::size_t groups = 0;                      // >= 2
  std::array<int, kMaxBlocks> azimuth{};       // 0.01 deg at the group's reference time
  std::array<bool, kMaxBlocks> jump{};         // the step to the next group does not fit the rotation
  std::array<Nanoseconds, kMaxBlocks> time{};  // of the group's reference, after the first group's
  double step = 0.0;                           // 0.01 deg a block period, >= 0
  Nanoseconds period{};                        // of a block

  [[nodiscard]] double rate() const;  // rad/s
  /// The rotor's, rad, [0, 2 pi), `after` the reference of a group.
  [[nodiscard]] double azimuth_at(std::size_t group, Nanoseconds after) const;
  /// Last azimuth before the last jump, rad.
  [[nodiscard]] std::optional<double> cut_azimuth() const;
  /// When the rotor passed zero, after the first group's reference, between the two times.
  [[nodiscard]] std::optional<Nanoseconds> zero_crossing(Nanoseconds first, Nanoseconds last) const;
};

/// Nothing if the azimuths are no rotation: then `worst` is the step that is too wide, 0.01 deg.
/// The motor speed (rpm) gives the rate where it agrees with the azimuths, otherwise they do. Where a step
/// does not fit (the sensor leaves a sector out) the jump's time is taken from the rate.
/// Precondition: 2 to kMaxBlocks azimuths in [0, 36000).
[[nodiscard]] std::optional<Rotation> read_rotation(std::span<const int> azimuths, double motor_rpm,
                                                    Nanoseconds period, int& worst);

}  // namespace hulltrack::hesai
