// The state machine of a frame: may anybody believe this frame's pose? judge_health() is a pure function.
//
// Input: the limits, the memory of earlier frames, the findings of this frame (its pose and what checks
// found). Output: the memory for the next frame, and the verdict: a state, fault bits and the reason in
// words. Every frame begins as tracking; each check can only make that worse. Only tracking is health 1.
//   held       the PLC does not want tracking
//   fault      PLC data is stale or no joint samples bracket the scan: nothing was registered
//   tracking   no check objects; after another state, not before recover_frames frames in a row
//   degraded   a pose, but: Q1 above its limit for tracking, not converged, not constrained, a jump or a
//              speed that a moored hull does not have, a machine that its witnesses contradict, joint values
//              on trial, a LiDAR silent or disputed, too early to say which ship it is, or recovering
//   lost       no pose to trust: none found, too few matches, Q1 above its limit for lost, contradicted by
//              the scan, outside hull.envelope, tilted or turned beyond hull.max_heel, max_trim or max_yaw,
//              or of a hull that ran away
//   acquiring  instead of degraded and lost while the hull has to be searched for (Track::unique is false)
// A scan may look the same one hatch farther along the quay. So health needs Track::unique: the whole berth
// was searched and no other place explains the scan as well. It ends when the last accepted pose is so old
// that the hull could have moved by kUnseen since.
// A hull that ran away (kLongestRun) stays lost until a re-acquire edge says that a person has looked, or
// until a map of the quay confirms all joints. Metres, radians. The publisher judges the pose's age.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "core/base/status.hpp"
#include "core/localisation/track.hpp"
#include "core/tracking/frame_findings.hpp"
#include "core/tracking/tracker_config.hpp"

namespace hulltrack {

/// A hull that runs farther than this while faster than hull.max_speed has run away. The fastest jerk that a
/// passing ship gives a moored hull does not reach as far. So the hull is under way, or an encoder stands
/// still while the loader moves; the two look the same.
inline constexpr double kLongestRun = 1.0;  // m

struct HealthMemory {
  /// How far some part of the hull has run faster than max_speed. A pause of up to 1.5 s does not end a run.
  struct FastRun {
    double length;  // m
    MeasurementTime last;
  };
  State state = State::starting;
  Track track;
  int good_frames = 0;  // frames in a row without objection, counted for recover_frames
  std::optional<FastRun> run;
  bool ran_away = false;  // farther than kLongestRun; ends as told in the file's head
};

struct HealthVerdict {
  State state = State::starting;
  Faults faults = 0;
  std::string reason;  // plain words with figures; empty when tracking
};

struct HealthLimits {
  HealthConfig health;
  Eigen::Vector3d envelope_min, envelope_max;  // displacement, m
  Eigen::Vector3d max_rpy;                     // of roll, pitch, yaw of T_W_H (heel, trim, yaw), rad
  double max_speed = 0.3;                      // m/s, of any part of the hull
  double half_length = 0.0;                    // half of the mapped hull's longer horizontal side, m
};

/// The limits that a configuration and the size of the map set.
[[nodiscard]] HealthLimits health_limits(const TrackerConfig& config, double half_length);

[[nodiscard]] std::pair<HealthMemory, HealthVerdict> judge_health(const HealthLimits& limits,
                                                                  HealthMemory memory,
                                                                  const FrameFindings& findings);

}  // namespace hulltrack
