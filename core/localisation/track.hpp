// What one frame leaves to the next: where the hull was seen, how she moves, and whether she may lie
// elsewhere.
//
// Frame W; metres, radians. A plain value of bounded size.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/time.hpp"
#include "core/geometry/hull_pose.hpp"
#include "core/localisation/hull_speed_record.hpp"

namespace hulltrack {

/// If the hull may have moved by more than this while she was not seen, the berth is searched for her. An
/// alignment from a start this far off still ends at the right place; from several metres off it ends
/// elsewhere.
inline constexpr double kUnseen = 1.0;  // m

/// No moored hull moves faster: twice the fastest pull of a passing ship, a metre within some seconds.
inline constexpr double kFastestHull = 0.6;  // m/s

struct FollowedPose {
  MeasurementTime time;
  HullPose pose;
};

struct Track {
  std::optional<FollowedPose> followed;     // the last pose that the scan did not contradict
  HullSpeedRecord speed_record;             // of the followed poses
  bool unique = false;                      // the pose follows from one that no other place rivalled
  std::optional<FollowedPose> last_unique;  // the last followed pose that was unique, since a re-acquire edge
  std::uint64_t searches = 0;               // counts up each time that the berth has to be searched anew
};

}  // namespace hulltrack
