// May anybody believe this frame's pose? The state machine, as a pure function.
//
// (configuration, memory of earlier frames, evidence of this frame) -> (memory, verdict). No check can give
// health: it is what is left when none takes it away, recover_frames times in a row.
//   held       the PLC does not want tracking
//   fault      no joints bracket the scan, or PLC data stale: nothing was registered
//   tracking   every check passed, now and (unless tracking already) in recover_frames frames in a row
//   degraded   a pose, but: Q1 above q1_healthy, not converged, not constrained, implausible, or recovering
//   lost       no pose to trust: none found, too few matches, Q1 above q1_lost, contradicted by the scan
//   acquiring  instead of degraded and lost until health is first 1, and again after a re-acquire edge
// A hull that the scan saw elsewhere for kSeenElsewhere may come to rest where its next hatch looks like the
// one in the map. No figure of a frame can tell: from then on it is ambiguous and acquiring until a
// re-acquire edge. Metres, radians. The pose's age is the publisher's business.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/base/status.hpp"
#include "core/tracking/integrity.hpp"
#include "core/tracking/metrics.hpp"
#include "core/tracking/motion_record.hpp"
#include "core/tracking/tracker_config.hpp"

namespace hulltrack {

/// Everything that one frame says for or against itself.
struct Evidence {
  MeasurementTime time{};  // middle of the scan
  bool hold = false;
  bool reacquire = false;   // rising edge
  Faults plc_faults = 0;    // plc_stale, plc_value
  bool bracketed = false;   // joint samples bracket every packet
  bool registered = false;  // a pose was found; what follows speaks of it
  bool converged = false;
  std::uint32_t matched = 0;
  std::string trouble;  // of the registration: why there is no pose, or why it did not converge
  DistanceMetrics metrics;
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  // of the reference point, m
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // of T_W_H
  IntegrityFinding integrity;
};

/// At 0.3 m/s, a usual max_speed, a hull moves 6 m in this time: less than any ship's hatch pitch.
inline constexpr Nanoseconds kSeenElsewhere = std::chrono::seconds(20);

struct HealthMemory {
  struct HealthyPose {
    MeasurementTime time;
    Eigen::Vector3d displacement;
    Eigen::Matrix3d rotation;
  };
  State state = State::starting;
  bool acquired = false;            // health has been 1 since the start or the last re-acquire edge
  int good_frames = 0;              // in a row
  Nanoseconds seen_elsewhere{0};    // frames that contradicted the pose since the last healthy one, together
  MeasurementTime last_judged{};    // the latest frame with a pose
  bool ambiguous = false;           // seen elsewhere for too long: only a re-acquire edge helps
  std::optional<HealthyPose> last;  // the last pose with health 1
  MotionRecord motion;              // of the poses that the scan did not contradict
};

struct HealthVerdict {
  State state = State::starting;
  Faults faults = 0;
  std::string reason;  // plain words with figures; empty when tracking
};

struct HealthLimits {
  HealthConfig health;
  Eigen::Vector3d envelope_min, envelope_max;  // displacement, m
  double max_speed = 0.3;                      // m/s, of any part of the hull
  double half_length = 0.0;                    // of the hull as far as it is mapped, level, m
};

/// The limits that a configuration and the size of the map set.
[[nodiscard]] HealthLimits health_limits(const TrackerConfig& config, double half_length);

[[nodiscard]] std::pair<HealthMemory, HealthVerdict> judge_health(const HealthLimits& limits,
                                                                  HealthMemory memory,
                                                                  const Evidence& evidence);

}  // namespace hulltrack
