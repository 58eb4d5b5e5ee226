#include "core/filter/scan_filter.hpp"

#include <algorithm>
#include <utility>

namespace hulltrack {
namespace {

bool inside_any(const std::vector<Box>& boxes, const Point& p) {
  return std::any_of(boxes.begin(), boxes.end(), [&p](const Box& box) { return box.contains(p); });
}

/// Takes a point of the hull to where it is `seconds` later.
Pose drifted(const HullDrift& drift, double seconds) {
  return pose_about(drift.about_W, so3_exp(seconds * drift.turning), seconds * drift.velocity);
}

}  // namespace

ScanFilter::ScanFilter(const MachineConfig& machine, std::vector<SensorConfig> sensors,
                       std::optional<Box> region_W)
    : machine_(machine), sensors_(std::move(sensors)), region_W_(std::move(region_W)) {}

void ScanFilter::run(const Scan& scan, const JointHistory& joints, const HullDrift& drift,
                     FilteredScan& out) const {
  out.returns_W.resize(sensors_.size());
  out.of.resize(sensors_.size());
  for (std::size_t lidar = 0; lidar < sensors_.size(); ++lidar) {
    out.returns_W[lidar].clear();
    out.of[lidar].clear();
  }
  out.hull_W.clear();
  out.segments_left_out = 0;
  for (const ScanSegment& segment : scan.segments) {
    const JointHistory::Answer at = joints.at(segment.time);
    const bool in_array =
        segment.first <= scan.points.size() && segment.count <= scan.points.size() - segment.first;
    if (at.lookup != JointHistory::Lookup::ok || segment.lidar >= sensors_.size() || !in_array) {
      ++out.segments_left_out;
      continue;
    }
    const Pose T_W_L = drifted(drift, to_seconds(scan.mid_time() - segment.time)) *
                       lidar_pose(machine_, at.joints, sensors_[segment.lidar].mount);
    run_segment(std::span(scan.points).subspan(segment.first, segment.count), segment.lidar, T_W_L, out);
  }
}

void ScanFilter::run_segment(std::span<const LidarPoint> points, std::uint16_t lidar, const Pose& T_W_L,
                             FilteredScan& out) const {
  const SensorConfig& sensor = sensors_[lidar];
  const auto square = [](double v) { return static_cast<float>(v * v); };
  const float min_range2 = square(sensor.min_range);
  const float max_range2 = square(sensor.max_range);
  // The rotation in float is exact to 1e-7 of the range: 12 um at 100 m.
  const Eigen::Matrix3f R = T_W_L.linear().cast<float>();
  const Point t = T_W_L.translation().cast<float>();
  Cloud& returns_W = out.returns_W[lidar];
  std::vector<ReturnOf>& of = out.of[lidar];
  for (const LidarPoint& point : points) {
    const Point p_L(point.x, point.y, point.z);
    const float range2 = p_L.squaredNorm();
    if (!(range2 >= min_range2 && range2 <= max_range2)) {  // also false for NaN
      continue;
    }
    const Point p_W = R * p_L + t;
    returns_W.push_back(p_W);
    if (inside_any(sensor.exclude, p_L)) {
      of.push_back(ReturnOf::machine);
    } else if (region_W_ && !region_W_->contains(p_W)) {
      of.push_back(ReturnOf::surroundings);
    } else {
      of.push_back(ReturnOf::hull);
      out.hull_W.push_back(p_W);
    }
  }
}

}  // namespace hulltrack
