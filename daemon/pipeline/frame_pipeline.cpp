#include "daemon/pipeline/frame_pipeline.hpp"

#include <chrono>
#include <utility>

#include "daemon/config/conversions.hpp"

namespace hulltrack {
namespace {

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
