// A ship of axis-aligned rectangles and a LiDAR above it, ray-cast by brute force: for tests of the tracker.
//
// Frames as everywhere: rectangles in H, scans in L. Deterministic for a seed. Small enough to be seen
// through at a glance; independent of the simulator.
#pragma once

#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/geometry/cloud.hpp"
#include "core/geometry/scan.hpp"
#include "core/geometry/se3.hpp"
#include "core/kinematics/joint_history.hpp"
#include "core/map/hull_map.hpp"

namespace hulltrack::testing {

/// A rectangle at coordinate `at` of `axis`, between low and high in the other two axes.
struct Rectangle {
  int axis;
  double at;
  Eigen::Vector3d low, high;
};

class AnalyticShip {
 public:
  /// Deck 60 x 20 m at z = 0, two hatches with coamings and holds, deck house, sides, some fittings.
  static AnalyticShip bulk_carrier();
  /// The same kind of ship, with everything elsewhere.
  static AnalyticShip other_carrier();

  /// Points on all rectangles, one a `spacing` square, with 5 mm noise.
  [[nodiscard]] Cloud map(double spacing, unsigned seed) const;

  /// Distance along a unit ray in H, or nothing within 200 m.
  [[nodiscard]] std::optional<double> cast(const Eigen::Vector3d& origin_H,
                                           const Eigen::Vector3d& ray_H) const;

  [[nodiscard]] const std::vector<Rectangle>& rectangles() const { return rectangles_; }

 private:
  void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  void add_hatch(double x0, double x1, double half_width, double height);
  void add(int axis, double at, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    rectangles_.push_back({axis, at, low, high});
  }

  std::vector<Rectangle> rectangles_;
};

/// The map of bulk_carrier(), one point a square of 7 cm: built once a process.
[[nodiscard]] const std::shared_ptr<const HullMap>& bulk_carrier_map();

/// A LiDAR that looks down: x_L = -Z_W, 65 rows over +-45 deg, 344 columns over +-60 deg.
[[nodiscard]] SensorConfig looking_down(const Eigen::Vector3d& position_W);

struct ScanOptions {
  Pose T_W_H = Pose::Identity();
  double range_sigma = 0.02;
  unsigned seed = 1;
  std::uint32_t frame = 0;
  double drop = 0.0;  // share of returns lost
};

/// One scan of 100 ms beginning at frame * 100 ms, the joints at zero. `ship` null = nothing but quay at z =
/// -5.
[[nodiscard]] Scan scan_ship(const AnalyticShip* ship, const SensorConfig& sensor,
                             const ScanOptions& options);

/// Joints at zero from -1 s to `seconds`, every 20 ms.
[[nodiscard]] JointHistory joints_at_rest(double seconds);

}  // namespace hulltrack::testing
