// A small quay for tests: its cloud, and what a sensor on a loader's boom sees of it.
//
// Top at z = 0 from y = -20 to y = 0, a wall along the rails (y = -20) and two across them (x = 14, x = 40),
// 6 m high; or a shed's end across them instead (x = 20), narrow and tall. W, metres. A map has the top on
// either side of the walls, a scan that of the near side. Returns are drawn from the surfaces themselves,
// with 2 cm of noise along the normal, and shown as a machine sees them that is not where it says: moved by
// E.
#pragma once

#include <random>
#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/sight/scan_view.hpp"
#include "core/witness/machine_wear.hpp"

namespace hulltrack::testing {

/// Slewing axis 8 m behind the quay's edge, boom of 20 m over the ship.
inline MachineConfig quay_machine() {
  MachineConfig machine;
  machine.slew.translation() = Eigen::Vector3d(0.0, -8.0, 17.0);
  machine.luff.translation() = Eigen::Vector3d(2.0, 0.0, 3.5);
  return machine;
}

inline Pose quay_mount() { return pose_from_xyz_rpy_deg({18.4, 1.9, -1.6}, {0.0, 105.0, -30.0}); }

inline MachineStand stand_at(const Joints& joints, const Joints& rate = {}) {
  MachineStand stand;
  stand.joints = joints;
  stand.rate = rate;
  stand.sensor_W = lidar_pose(quay_machine(), joints, quay_mount()).translation();
  return stand;
}

struct QuaySurface {
  Point corner, u, v;  // corner + s u + t v, s and t in 0..1
};

inline const std::vector<QuaySurface>& quay_surfaces() {
  static const std::vector<QuaySurface> all = {
      {{-20.0F, -19.0F, 0.0F}, {33.0F, 0.0F, 0.0F}, {0.0F, 19.0F, 0.0F}},  // top
      {{14.0F, -19.0F, 1.0F}, {0.0F, 15.0F, 0.0F}, {0.0F, 0.0F, 5.0F}},    // across the rails
      {{-20.0F, -20.0F, 1.0F}, {33.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 5.0F}},   // along them
      {{40.0F, -19.0F, 1.0F}, {0.0F, 15.0F, 0.0F}, {0.0F, 0.0F, 5.0F}},    // across them
      {{20.0F, -19.0F, 1.0F}, {0.0F, 6.0F, 0.0F}, {0.0F, 0.0F, 12.0F}},    // a shed's end, across them
      {{13.0F, -19.0F, 0.0F}, {33.0F, 0.0F, 0.0F}, {0.0F, 19.0F, 0.0F}},   // ground behind the walls across
      {{-20.0F, -25.0F, 0.0F}, {66.0F, 0.0F, 0.0F}, {0.0F, 6.0F, 0.0F}}};  // and behind the one along
  return all;
}

/// Of the given surfaces, by index; a point each 10 cm.
inline Cloud quay_cloud(const std::vector<std::size_t>& surfaces = {0, 1, 2}) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> jitter(-0.04F, 0.04F);
  Cloud cloud;
  for (const std::size_t i : surfaces) {
    const QuaySurface& surface = quay_surfaces().at(i);
    const auto steps = [](const Point& side) { return static_cast<int>(side.norm() / 0.1F); };
    for (int s = 0; s < steps(surface.u); ++s) {
      for (int t = 0; t < steps(surface.v); ++t) {
        cloud.push_back(surface.corner +
                        (static_cast<float>(s) * 0.1F + jitter(random)) * surface.u.normalized() +
                        (static_cast<float>(t) * 0.1F + jitter(random)) * surface.v.normalized());
      }
    }
  }
  return cloud;
}

/// A frame of such a machine, of `count` returns of each surface of the quay and of what stands there
/// besides.
struct QuayFrame {
  FilteredScan scan;
  std::vector<ScanView> views{1};
  MachineStand stand;
};

inline QuayFrame quay_frame(const Joints& reported, const Pose& E, unsigned seed, int count = 400,
                            const std::vector<std::size_t>& surfaces = {0, 1, 2},
                            const std::vector<QuaySurface>& besides = {}) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> along(0.02F, 0.98F);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  QuayFrame frame;
  frame.stand = stand_at(reported);
  Cloud& returns_W = frame.scan.returns_W.emplace_back();
  std::vector<QuaySurface> shown;
  for (const std::size_t i : surfaces) {
    shown.push_back(quay_surfaces().at(i));
  }
  shown.insert(shown.end(), besides.begin(), besides.end());
  for (const QuaySurface& surface : shown) {
    for (int k = 0; k < count; ++k) {
      const Point p = surface.corner + along(random) * surface.u + along(random) * surface.v +
                      noise(random) * surface.u.cross(surface.v).normalized();
      returns_W.push_back((E * p.cast<double>()).cast<float>());
    }
  }
  frame.scan.of.emplace_back(returns_W.size(), ReturnOf::surroundings);
  frame.views.front().rebuild(returns_W, lidar_pose(quay_machine(), reported, quay_mount()));
  return frame;
}

/// Where such a machine puts what stands still: T_W_L as reported * (T_W_L true)^-1.
inline Pose misplaced(const Joints& reported, const Joints& truth) {
  return lidar_pose(quay_machine(), reported, quay_mount()) *
         lidar_pose(quay_machine(), truth, quay_mount()).inverse();
}

}  // namespace hulltrack::testing
