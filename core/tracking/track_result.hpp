// What one frame came to, healthy or not.
//
// Frame W; metres, radians. A plain value.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "core/geometry/hull_pose.hpp"
#include "core/quay/quay_top.hpp"
#include "core/sight/metrics.hpp"
#include "core/tracking/frame_findings.hpp"
#include "core/tracking/health.hpp"
#include "core/tracking/motion_products.hpp"
#include "core/witness/machine_doubt.hpp"

namespace hulltrack {

struct TrackResult {
  std::uint32_t frame = 0;
  MeasurementTime time{};  // middle of the scan

  bool registered = false;  // false: members down to `metrics` mean nothing
  HullPose pose;            // found by this frame's registration
  bool converged = false;
  int iterations = 0;
  std::uint32_t matched = 0;        // points of the last ICP iteration
  double sigma_translation = -1.0;  // 1-sigma, largest principal axis, m; -1 = unknown
  double sigma_rotation = -1.0;     // rad; -1 = unknown
  /// Covariance of the pose's error at the reference point, [rotation; translation], W, rad and m. Zero if
  /// sigma_translation is unknown or the registration method is not `automatic`.
  Matrix6 covariance = Matrix6::Zero();
  double bend = 0.0;         // m, sag (+) or hog (-) of amidships against the ends since the map was made
  double sigma_bend = -1.0;  // m; -1 = unknown
  DistanceMetrics metrics;   // metrics.valid tells whether there are any

  State state = State::starting;  // of this frame alone; the publisher judges its age and later silence
  bool health = false;            // true if and only if state == tracking
  Faults faults = 0;
  std::string reason;  // why health is 0, in plain words with figures; empty when healthy

  /// True if the returns on the quay's map confirm all six axes of the LiDAR's pose in W, and the view would
  /// have shown a large error of each joint.
  bool joints_confirmed = false;
  /// By JointName: what the quay says of each joint in this frame.
  std::array<JointDoubt, 3> joint_doubts;
  /// The quay's level surface as this session found it; empty before that, and if it need not be found.
  std::optional<SeenTop> found_top;

  MotionProducts motion;
};

/// Of a frame with these findings and this verdict. Without its number, the quay's top and the hull's motion.
[[nodiscard]] TrackResult track_result(const FrameFindings& findings, HealthVerdict verdict);

}  // namespace hulltrack
