// What a RoboSense unit tells about itself once a second: its DIFOP packet.
//
// 1248 bytes, big endian: id A5 FF 00 5A 11 11 55 55, rpm @8, return mode @300. Angles:
//   all models but the RS16   32 vertical @468, 32 horizontal @564, each {sign u8, u16 in 0.01 deg}; sign 0
//   is
//                             up or clockwise, 1 down or counter-clockwise, 0xFF not calibrated
//   RS16                      16 vertical @1165, each 24 bits in 0.0001 deg, lasers 0-7 below the horizon,
//   8-15
//                             above; no horizontal ones
// The number of lasers is not stated but can be counted: no two lasers of a unit look up equally far (the
// narrowest spacing of any model is 0.33 deg). With 32 lasers all entries differ; with 16 the second half is
// not calibrated, filled with one value, or repeats the first. A packet between the two is not believed.
// The Bpearl shows by a laser that looks up by more than 50 deg: its own cover the 90 deg from the horizon to
// the zenith (user manual, 6.1), no other model's look up by more than 15 deg.
// Of these the capture proves the 32-laser Helios; the others' places are the maker's driver's.
// The clock's state @302 is that of the Helios and the Bpearl: 0 not synchronised, 1 by GPS, 2 by PTP
// (Nebula's decoders; the capture's unit says 0 and shows 2017). In the RS16's and RS32's packets other
// things stand there, and a Ruby Plus, which is none of these models, counts the other way round (user
// manual, B.13: 0 is success). Thread rule: pure functions.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/result.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/robosense/robosense_format.hpp"

namespace hulltrack::robosense {

inline constexpr std::array<std::uint8_t, 8> kDifopId = {0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
inline constexpr std::size_t kDifopRpmOffset = 8;
inline constexpr std::size_t kDifopReturnModeOffset = 300;
inline constexpr std::size_t kDifopClockOffset = 302;
inline constexpr std::size_t kDifopVerticalOffset = 468;
inline constexpr std::size_t kDifopHorizontalOffset = 564;
inline constexpr std::size_t kDifopRs16VerticalOffset = 1165;
inline constexpr std::size_t kAngleBytes = 3;

struct LaserAngles {
  double elevation_deg;
  double azimuth_deg;  // to be added to the rotor's azimuth
  friend bool operator==(const LaserAngles&, const LaserAngles&) = default;
};

struct Difop {
  std::size_t lasers;                      // of the unit, whatever the model that was asked for: 16 or 32
  std::array<LaserAngles, kSlots> angles;  // of the first `lasers`
  bool to_zenith;                          // as ModelTable's
  double rpm;                              // as set; 0 = not told
  std::uint8_t mode_code;
  ReturnMode mode;  // unknown: the code is none of the model's
  ClockReference clock_reference;
};

/// Is it a DIFOP packet of any model?
[[nodiscard]] bool is_difop(Bytes payload);

/// An error says what is wrong with the packet and what is allowed. A unit of another model is none: see
/// fits().
[[nodiscard]] Result<Difop> read_difop(Bytes payload, const ModelTable& model);

/// Are the unit's lasers those of the model, as far as can be told?
[[nodiscard]] bool fits(const Difop& unit, const ModelTable& model);

}  // namespace hulltrack::robosense
