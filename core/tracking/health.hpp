// May anybody believe this frame's pose? The state machine, as a pure function.
//
// (configuration, memory of earlier frames, evidence of this frame) -> (memory, verdict). No check can give
// health: it is what is left when none takes it away, recover_frames times in a row.
//   held       the PLC does not want tracking
//   fault      no joints bracket the scan, or PLC data stale: nothing was registered
//   tracking   every check passed, now and (unless tracking already) in recover_frames frames in a row
//   degraded   a pose, but: Q1 above its limit for tracking, not converged, not constrained, a jump or a
//              speed that a moored hull does not have, a machine that its witnesses contradict, joint values
//              on trial, a LiDAR silent or disputed, or recovering
//   lost       no pose to trust: none found, too few matches, Q1 above its limit for lost, contradicted by
//   the
//              scan, outside hull.envelope, tilted or turned beyond hull.max_heel, max_trim or max_yaw, or of
//              a hull that ran away
//   acquiring  instead of degraded and lost while the hull has to be searched for
// A scan may look the same one hatch farther along the quay, so a pose is believed only if it follows from an
// earlier one without a gap in which the hull could have moved by kUnseen, or if the whole berth was searched
// since and no other place explains the scan as well. A hull that ran away (kLongestRun) is not believed
// again before a person has looked, a re-acquire edge, or a map of the quay has confirmed all joints. Metres,
// radians. The pose's age is the publisher's
// business.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/base/status.hpp"
#include "core/integrity/integrity.hpp"
#include "core/localisation/search_evidence.hpp"
#include "core/localisation/track.hpp"
#include "core/sight/metrics.hpp"
#include "core/tracking/tracker_config.hpp"
#include "core/witness/machine_finding.hpp"

namespace hulltrack {

/// Everything that one frame says for or against itself.
struct Evidence {
  MeasurementTime time{};  // middle of the scan
  bool hold = false;
  bool reacquire = false;  // rising edge
  Faults standing = 0;     // plc_stale, plc_value, lidar_silent, clock; foreign_packets: a disputed sensor
  bool bracketed = false;  // joint samples bracket every packet
  bool joints_on_trial = false;  // samples among them that nothing confirms yet
  std::string joint_trouble;     // why joint values are refused or on trial
  bool registered = false;       // a pose was found; what follows speaks of it
  bool converged = false;
  std::uint32_t matched = 0;
  std::string trouble;  // of the registration: why there is no pose, or why it did not converge
  DistanceMetrics metrics;
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  // of the reference point, m
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // of T_W_H
  IntegrityFinding integrity;
  MachineFinding machine;
  SearchEvidence search;
};

/// The longest way on which a moored hull is faster than hull.max_speed: all of the fastest jerk that a
/// passing ship gives her. One that runs farther is under way, or an encoder stands still while the loader
/// moves, and nobody can tell which.
inline constexpr double kLongestRun = 1.0;  // m

struct HealthMemory {
  /// How far some part of the hull has run faster than max_speed, without a pause.
  struct FastRun {
    double length;  // m
    MeasurementTime last;
  };
  State state = State::starting;
  Track track;
  int good_frames = 0;  // in a row
  std::optional<FastRun> run;
  bool ran_away = false;  // farther than kLongestRun, until a re-acquire edge or a quay map's word
};

struct HealthVerdict {
  State state = State::starting;
  Faults faults = 0;
  std::string reason;  // plain words with figures; empty when tracking
};

struct HealthLimits {
  HealthConfig health;
  Eigen::Vector3d envelope_min, envelope_max;  // displacement, m
  Eigen::Vector3d max_rpy;                     // heel, trim and yaw about the map's attitude, rad
  double max_speed = 0.3;                      // m/s, of any part of the hull
  double half_length = 0.0;                    // of the hull as far as it is mapped, level, m
};

/// The limits that a configuration and the size of the map set.
[[nodiscard]] HealthLimits health_limits(const TrackerConfig& config, double half_length);

[[nodiscard]] std::pair<HealthMemory, HealthVerdict> judge_health(const HealthLimits& limits,
                                                                  HealthMemory memory,
                                                                  const Evidence& evidence);

}  // namespace hulltrack
