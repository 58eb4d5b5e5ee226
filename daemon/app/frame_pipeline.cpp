#include "daemon/app/frame_pipeline.hpp"

#include <algorithm>
#include <chrono>

namespace hulltrack {
namespace {

Point corner(const std::array<double, 6>& box, std::size_t first) {
  return {static_cast<float>(box[first]), static_cast<float>(box[first + 1]),
          static_cast<float>(box[first + 2])};
}

JointLimits limits_in_radians(const JointRegister& joint) {
  return {radians(joint.min), radians(joint.max), radians(joint.max_rate)};
}

Faults packet_faults(const Scan& scan) {
  Faults faults = 0;
  for (const LidarFrameCounters& lidar : scan.lidars) {
    if (lidar.packets_lost > 0) {
      faults |= fault::frame_incomplete;
    }
    if (lidar.packets_rejected > 0) {
      faults |= fault::foreign_packets;
    }
  }
  return faults;
}

}  // namespace

std::vector<SensorConfig> sensor_configs(const std::vector<LidarConfig>& lidars) {
  std::vector<SensorConfig> sensors;
  for (const LidarConfig& lidar : lidars) {
    SensorConfig sensor{lidar.mount, lidar.min_range, lidar.max_range, {}};
    for (const auto& box : lidar.exclude) {
      sensor.exclude.push_back({corner(box, 0), corner(box, 3)});
    }
    sensors.push_back(std::move(sensor));
  }
  return sensors;
}

JointGateConfig joint_gate_config(const PlcConfig& plc) {
  const JointRegister& travel = plc.read.travel;
  return {.travel = {travel.min, travel.max, travel.max_rate},
          .slew = limits_in_radians(plc.read.slew),
          .luff = limits_in_radians(plc.read.luff),
          .poll_period = plc.poll_period,
          .has_heartbeat = plc.heartbeat_timeout > Nanoseconds{0},
          .has_command = plc.read.command >= 0};
}

Joints joints_from_plc(double travel_m, double slew_deg, double luff_deg) {
  return {travel_m, radians(slew_deg), radians(luff_deg)};
}

FramePipeline::FramePipeline(const Config& config, std::shared_ptr<const HullMap> map,
                             std::shared_ptr<const QuayMap> quay)
    : tracker_(config.tracker, config.machine, sensor_configs(config.lidars), std::move(map),
               std::move(quay)) {}

FrameReport FramePipeline::process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs) {
  const auto start = std::chrono::steady_clock::now();
  FrameReport report{tracker_.process(scan, joints, inputs), {}};
  report.track.faults |= packet_faults(scan);
  report.processing = std::chrono::steady_clock::now() - start;
  return report;
}

}  // namespace hulltrack
