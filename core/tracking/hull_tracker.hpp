// One scan in, one TrackResult out: where is the hull, and may anybody believe it?
//
// Frames: scans in L, joints -> W, map in H; the answer is T_W_H. The pose is that of the middle of
// the scan. Asks no clock and does no I/O; the same calls in the same order give the same bits.
// Thread rule: one owner. Cost: bounded by the scan's points (core/README.md).
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
  /// What stands against the inputs: plc_stale, plc_value, lidar_silent, clock; foreign_packets: disputed
  /// sensor.
  Faults standing = 0;
  std::string joint_trouble{};  // why joint values are refused or on trial, for the reason; "" if none are
};

/// What one frame came to, healthy or not.
struct TrackResult {
  std::uint32_t frame = 0;
  MeasurementTime time{};  // middle of the scan

  bool registered = false;                                 // everything below up to `metrics` is meaningful
  Pose T_W_H = Pose::Identity();                           // hull pose found by this frame's registration
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  // T_W_H * p_ref - p_ref, m
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();           // of T_W_H, rad
  bool converged = false;
  int iterations = 0;
  std::uint32_t matched = 0;        // points of the last ICP iteration
  double sigma_translation = -1.0;  // 1-sigma, largest principal axis, m; -1 = unknown
  double sigma_rotation = -1.0;     // rad; -1 = unknown
  /// Of the pose's error at the reference point, [rotation; translation], W, rad and m; meaningful when
  /// sigma_translation >= 0.
  Matrix6 covariance = Matrix6::Zero();
  double bend = 0.0;         // m, sag (+) or hog (-) of amidships against the ends since the map was made
  double sigma_bend = -1.0;  // m; -1 = unknown
  DistanceMetrics metrics;   // metrics.valid tells whether there are any

  State state = State::starting;  // starting/held/fault as far as the frame's inputs tell
  bool health = false;            // true if and only if state == tracking
  Faults faults = 0;
  std::string reason;  // why health is 0, in plain words with figures; empty when healthy

  /// The scan itself shows that the joints are right on all six axes of the LiDAR's pose in W, by what stands
  /// still on the quay.
  bool joints_confirmed = false;
  /// By JointName: what the quay says of each joint in this frame.
  std::array<JointDoubt, 3> joint_doubts;
  /// The quay's top as this session found it, from the frame on in which it did, if nobody has measured it.
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

  /// `joints` must hold every sample available; a scan that it does not bracket is not registered.
  [[nodiscard]] TrackResult process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hulltrack
