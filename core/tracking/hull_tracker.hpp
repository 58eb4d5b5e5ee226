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
#include "core/tracking/track_result.hpp"
#include "core/tracking/tracker_config.hpp"

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
