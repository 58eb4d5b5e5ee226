// What one frame leaves to the next: where the hull was seen, how she moves, and whether she may lie
// elsewhere.
//
// W; metres, radians. A plain value of bounded size.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/base/time.hpp"
#include "core/localisation/motion_record.hpp"

namespace hulltrack {

/// A hull that may have moved by more than this unseen is searched for: alignments from starts this far off
/// still end at the right place, those from several metres on at places of their own.
inline constexpr double kUnseen = 1.0;  // m

/// Nothing moves a moored hull faster: twice the fastest jerk of a passing ship, a metre within some seconds.
inline constexpr double kFastestHull = 0.6;  // m/s

struct FollowedPose {
  MeasurementTime time;
  Eigen::Vector3d displacement;  // of the reference point
  Eigen::Matrix3d rotation;      // of T_W_H
};

struct Track {
  std::optional<FollowedPose> followed;  // the last pose that the scan did not contradict
  MotionRecord motion;                   // of the followed poses
  bool unique = false;                   // the pose follows from one that no other place rivalled
};

}  // namespace hulltrack
