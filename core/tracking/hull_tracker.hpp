// One scan in, one TrackResult out: where is the hull, and may anybody believe it?
//
// Input: a scan (points in L), joint samples (they place the LiDARs in W), the ship's map (H). Output: T_W_H
// at the middle of the scan. Asks no clock and does no I/O; the same calls in the same order give the same
// bits. Thread rule: one owner. Cost: bounded by the scan's points (core/README.md).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/status.hpp"
#include "core/filter/scan_filter.hpp"
#include "core/geometry/scan.hpp"
#include "core/geometry/se3.hpp"
#include "core/kinematics/joint_history.hpp"
#include "core/kinematics/loader_kinematics.hpp"
#include "core/map/hull_map.hpp"
#include "core/quay/quay_map.hpp"
#include "core/quay/quay_top.hpp"
#include "core/sight/metrics.hpp"
#include "core/tracking/motion_products.hpp"
#include "core/tracking/tracker_config.hpp"
#include "core/witness/machine_doubt.hpp"

namespace hulltrack {

/// What surrounds one scan besides its points.
struct FrameInputs {
  bool hold = false;       // the PLC's command word: no tracking wanted
  bool reacquire = false;  // rising edge since the previous frame
  /// Faults of the inputs that hold now: plc_stale, plc_value, lidar_silent, clock; foreign_packets means
  /// here that two sensors send to one LiDAR's port.
  Faults standing = 0;
  std::string joint_trouble{};  // why joint values are refused or on trial; "" if none are
};

/// What one frame came to, healthy or not.
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

class HullTracker {
 public:
  /// `map` must not be null; `quay` may be. Both are shared, immutable. `sensors` in the order of
  /// Scan::lidars.
  HullTracker(const TrackerConfig& config, const MachineConfig& machine, std::vector<SensorConfig> sensors,
              std::shared_ptr<const HullMap> map, std::shared_ptr<const QuayMap> quay = nullptr);
  ~HullTracker();
  HullTracker(HullTracker&&) noexcept;
  HullTracker& operator=(HullTracker&&) noexcept;

  /// `joints`: all samples so far. A scan is registered only if samples lie before and after every datagram.
  [[nodiscard]] TrackResult process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hulltrack
