// Which conditions of the inputs hold now? One answer for the live service and for a replay.
//
// On measurement time; `now` is handed in. Thread rule: plain values, one owner.
#pragma once

#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "core/kinematics/joint_history.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "plc/plc_config.hpp"

namespace hulltrack {

/// Since when has the PLC said nothing new?
class PlcNews {
 public:
  /// Data counts as new at `start`.
  PlcNews(const PlcConfig& config, MeasurementTime start)
      : stale_after_(config.heartbeat_timeout > Nanoseconds{0} ? config.heartbeat_timeout
                                                               : JointHistory::kMaxGap),
        last_(start) {}

  /// A new sample: the heartbeat has moved, and the sample is not torn.
  void heard(MeasurementTime at) { last_ = at; }
  [[nodiscard]] Nanoseconds silence(MeasurementTime now) const { return now - last_; }
  /// After heartbeat_timeout, or after 250 ms where the PLC has no heartbeat.
  [[nodiscard]] bool is_stale(MeasurementTime now) const { return silence(now) > stale_after_; }

 private:
  Nanoseconds stale_after_;
  MeasurementTime last_;
};

/// How long a LiDAR has sent no usable packet; before the first one since `start`.
[[nodiscard]] inline Nanoseconds silence_of(const LidarStatus& lidar, MeasurementTime start,
                                            MeasurementTime now) {
  return now - (lidar.packets > 0 ? lidar.last_received : start);
}

/// lidar_silent, clock, and foreign_packets while nobody can say which of two sensors is meant.
[[nodiscard]] inline Faults standing_of(const LidarStatus& lidar, bool silent) {
  Faults standing = 0;
  standing |= silent ? fault::lidar_silent : Faults{0};
  standing |= lidar.clock_fault ? fault::clock : Faults{0};
  standing |= lidar.disputed ? fault::foreign_packets : Faults{0};
  return standing;
}

}  // namespace hulltrack
