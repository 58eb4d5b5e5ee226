// What the service tells the PLC: every field of the write block (ICD 2.2) as a plain value.
//
// Units are those of the registers: m, deg, ms. The pose is the last one whose health was 1; distances,
// `matched` and `processing_ms` belong to the newest frame. Unknown values have agreed figures, never NaN.
// The default is what a service that has seen nothing reports. Thread rule: a plain value.
#pragma once

#include <cstdint>

#include "core/base/status.hpp"

namespace hulltrack {

inline constexpr double kUnknownSigma = -1.0;       // m or deg
inline constexpr double kUnknownDistance = 9999.0;  // m
inline constexpr double kUnknownAgeMs = 1e7;        // before the first healthy pose

struct WriteBlock {
  bool health = false;  // this pose may steer the machine
  State state = State::starting;
  Faults faults = 0;
  std::uint32_t frame = 0;  // number of the LiDAR frame that the pose comes from
  double x_m = 0.0;         // displacement of the hull's reference point, in W
  double y_m = 0.0;
  double z_m = 0.0;
  double roll_deg = 0.0;  // of T_W_H
  double pitch_deg = 0.0;
  double yaw_deg = 0.0;
  double q1_m = kUnknownDistance;
  double mean_m = kUnknownDistance;
  double median_m = kUnknownDistance;
  double q3_m = kUnknownDistance;
  double rms_m = kUnknownDistance;
  std::uint32_t matched = 0;                   // points of the last ICP iteration
  double age_ms = kUnknownAgeMs;               // now minus the mid-time of the pose's scan, when written
  double sigma_translation_m = kUnknownSigma;  // 1-sigma, largest principal axis
  double sigma_rotation_deg = kUnknownSigma;
  double processing_ms = 0.0;        // last packet received to registers ready
  std::uint16_t command_echo = 0;    // last command word read
  std::uint16_t heartbeat = 0;       // +1 at every write; the client puts it in
  std::uint16_t heartbeat_copy = 0;  // differs from `heartbeat` while a block is torn; the client puts it in

  bool operator==(const WriteBlock&) const = default;
};

}  // namespace hulltrack
