// The words in which the service reports: states and fault bits as they stand in the registers.
//
// Values are the contract with the PLC (ICD 2.2, 2.3) and never change meaning.
#pragma once

#include <cstdint>

namespace hulltrack {

enum class State : std::uint16_t {
  starting = 0,   // no complete frame since the start
  tracking = 1,   // all good; the only state with health 1
  degraded = 2,   // a pose, but a check failed or recover_frames is running
  lost = 3,       // no pose that can be trusted
  acquiring = 4,  // searching for the hull
  fault = 5,      // an input is missing: LiDAR silent, PLC stale, map unusable
  held = 6,       // the PLC's command
  stopped = 7,    // clean stop
};

/// Lower-case word of a state, for logs.
[[nodiscard]] constexpr const char* state_name(State state) {
  switch (state) {
    case State::starting:
      return "starting";
    case State::tracking:
      return "tracking";
    case State::degraded:
      return "degraded";
    case State::lost:
      return "lost";
    case State::acquiring:
      return "acquiring";
    case State::fault:
      return "fault";
    case State::held:
      return "held";
    case State::stopped:
      return "stopped";
  }
  return "unknown";
}

/// A set of fault bits.
using Faults = std::uint16_t;

namespace fault {
inline constexpr Faults plc_link_lost = 1u << 0;  // event
inline constexpr Faults plc_stale = 1u << 1;
inline constexpr Faults plc_value = 1u << 2;
inline constexpr Faults lidar_silent = 1u << 3;
inline constexpr Faults foreign_packets = 1u << 4;   // event
inline constexpr Faults frame_incomplete = 1u << 5;  // event
inline constexpr Faults not_converged = 1u << 6;
inline constexpr Faults few_matches = 1u << 7;
inline constexpr Faults q1_high = 1u << 8;
inline constexpr Faults unconstrained = 1u << 9;
inline constexpr Faults implausible = 1u << 10;    // event
inline constexpr Faults frame_dropped = 1u << 11;  // event
inline constexpr Faults clock = 1u << 12;
inline constexpr Faults map_unusable = 1u << 13;
inline constexpr Faults contradicted = 1u << 14;
inline constexpr Faults ambiguous = 1u << 15;

/// Events stay set for at least one second; the other bits as long as their condition holds.
inline constexpr Faults events =
    plc_link_lost | foreign_packets | frame_incomplete | implausible | frame_dropped;
}  // namespace fault

}  // namespace hulltrack
