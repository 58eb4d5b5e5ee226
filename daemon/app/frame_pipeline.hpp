// One scan to one report: the code that the live service and `hulltrack replay` share.
//
// It turns the configuration into the tracker's terms, adds what the drivers counted to the tracker's
// faults and measures how long it all took. Time enters only as that duration: the report's poses and
// states depend on the inputs alone. Thread rule: one owner. Failure: none, states and faults instead.
#pragma once

#include <memory>
#include <vector>

#include "core/kinematics/joint_gate.hpp"
#include "core/tracking/hull_tracker.hpp"
#include "daemon/config/config.hpp"

namespace hulltrack {

/// Bits of the PLC's command word (ICD 2.1).
inline constexpr std::uint16_t kCommandHold = 1u << 0;
inline constexpr std::uint16_t kCommandReacquire = 1u << 1;

/// Remembers the command word between frames, so that a re-acquire edge between two frames is not
/// missed. Starts with the word 0.
class CommandLatch {
 public:
  /// A command word as read; true on a rising re-acquire edge.
  bool read(std::uint16_t command) {
    const bool edge = (command & ~command_ & kCommandReacquire) != 0;
    command_ = command;
    reacquire_ = reacquire_ || edge;
    return edge;
  }
  [[nodiscard]] std::uint16_t command() const { return command_; }
  [[nodiscard]] bool hold() const { return (command_ & kCommandHold) != 0; }
  /// True once after each edge.
  [[nodiscard]] bool take_reacquire() {
    const bool taken = reacquire_;
    reacquire_ = false;
    return taken;
  }

 private:
  std::uint16_t command_ = 0;
  bool reacquire_ = false;
};

/// The configuration's LiDARs in the tracker's terms, in the order of Scan::lidars.
[[nodiscard]] std::vector<SensorConfig> sensor_configs(const std::vector<LidarConfig>& lidars);

/// The configuration's joint limits in SI units.
[[nodiscard]] JointGateConfig joint_gate_config(const PlcConfig& plc);

/// Joint values in the PLC's units (m, deg) to SI.
[[nodiscard]] Joints joints_from_plc(double travel_m, double slew_deg, double luff_deg);

struct FrameReport {
  TrackResult track;
  Nanoseconds processing{0};  // this call's duration
};

class FramePipeline {
 public:
  /// `map` as for HullTracker.
  FramePipeline(const Config& config, std::shared_ptr<const HullMap> map);

  [[nodiscard]] FrameReport process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs);

 private:
  HullTracker tracker_;
};

}  // namespace hulltrack
