// Takes every return of a scan from its sensor's frame L to the world W, and says which of them may be hull.
//
//   1. Each segment (the points of a datagram) gets one T_W_L from the joints at its own time: the loader
//      moves less than 1 mm within a datagram.
//   2. Its returns are moved on with the hull's drift, to where the hull is at the middle of the scan. This
//      holds for all returns, also those of the quay.
//   3. Returns outside of the sensor's limits of range are left out, and so are NaN and infinite points.
//   4. A return may be hull if no exclude box in L holds it and the region in W does.
// Frames L and W, metres. Precondition: the joint history covers the scan (the caller asks covers() first). A
// segment without joints, of an unknown LiDAR, or outside the point array is left out and counted.
// Thread rule: one owner. Cost: one pass, no allocation once the buffers have grown to the scan's size.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/box.hpp"
#include "core/geometry/cloud.hpp"
#include "core/geometry/scan.hpp"
#include "core/kinematics/joint_history.hpp"
#include "core/kinematics/loader_kinematics.hpp"

namespace hulltrack {

/// What the tracker has to know of one LiDAR.
struct SensorConfig {
  Pose mount = Pose::Identity();  // T_lidar
  double min_range = 1.0;         // m
  double max_range = 120.0;       // m
  std::vector<Box> exclude;       // in L: the machine's own chute and boom
};

/// What a return may be of. Without a region, all that is not in an exclude box counts as hull.
enum class ReturnOf : std::uint8_t {
  surroundings,  // outside of the region
  hull,          // it is in FilteredScan::hull_W
  machine,       // in an exclude box
};

struct FilteredScan {
  std::vector<Cloud> returns_W;           // per LiDAR: all returns of valid range, hull or not
  std::vector<std::vector<ReturnOf>> of;  // for each return in returns_W
  Cloud hull_W;                           // returns that may be hull, at full resolution
  std::uint32_t segments_left_out = 0;
};

/// How the hull moves while a scan is taken: its returns are brought to where they are at the scan's middle.
struct HullDrift {
  Eigen::Vector3d about_W = Eigen::Vector3d::Zero();   // m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // of the hull at about_W, m/s
  Eigen::Vector3d turning = Eigen::Vector3d::Zero();   // rad/s, about W's axes
};

class ScanFilter {
 public:
  ScanFilter(const MachineConfig& machine, std::vector<SensorConfig> sensors, std::optional<Box> region_W);

  /// `out` is replaced.
  void run(const Scan& scan, const JointHistory& joints, const HullDrift& drift, FilteredScan& out) const;

  [[nodiscard]] const std::vector<SensorConfig>& sensors() const { return sensors_; }
  [[nodiscard]] const MachineConfig& machine() const { return machine_; }

 private:
  void run_segment(std::span<const LidarPoint> points, std::uint16_t lidar, const Pose& T_W_L,
                   FilteredScan& out) const;

  MachineConfig machine_;
  std::vector<SensorConfig> sensors_;
  std::optional<Box> region_W_;
};

}  // namespace hulltrack
