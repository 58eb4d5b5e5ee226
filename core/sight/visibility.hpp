// Which map points should this scan see if the hull lies where the pose says? (ICD 3)
//
// A point is visible if, seen from the mid-scan pose of at least one LiDAR, all of this holds:
//   - the LiDAR looks in its direction (ScanView::looks_at);
//   - its range is at least min_range, and at most the lesser of max_range and `farthest`;
//   - it is front-most in a range image of the map (cells of 1 deg, 0.4 m tolerance);
//   - the scan has no nearer return in its direction (ScanView::hidden).
// Frames: map in H, result in L of the LiDAR that sees the point; metres. Thread rule: one owner, scratch is
// kept. Cost: a few ns a map occluder and candidate. An occluder is a point of the thinned map that hides
// what lies behind it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/map/hull_map.hpp"
#include "core/sight/scan_view.hpp"

namespace hulltrack {

struct VisiblePoint {
  std::uint32_t index;  // into the candidates
  std::uint16_t lidar;  // the nearest that sees it
  Point p_L;            // where it is expected, in that LiDAR's frame
};

/// Leaves out the points that are farther from their LiDAR than `range`, m.
void keep_within(double range, std::vector<VisiblePoint>& visible);

class Visibility {
 public:
  /// `farthest`: largest range of a visible point, m.
  explicit Visibility(double farthest) : farthest_(farthest) {}

  /// `candidates_H`: map points to judge. `views` and `sensors`: one a LiDAR. `out` is replaced, in order of
  /// the candidates.
  void run(const HullMap& map, std::span<const Point> candidates_H, const Pose& T_W_H,
           std::span<const ScanView> views, std::span<const SensorConfig> sensors,
           std::vector<VisiblePoint>& out);

 private:
  void render(const PointBlocks& occluders_H, const Pose& T_L_H, const SightLimits& limits);
  void splat(SphericalGrid::Cell cell, float r);

  double farthest_;
  std::vector<float> cell_nearest_;   // per cell: squared range of the nearest occluder in it, m^2
  std::vector<float> map_nearest_;    // per cell: range of the nearest occluder that covers it, m
  std::vector<std::uint32_t> place_;  // per candidate: index in the result, if an earlier LiDAR sees it
};

}  // namespace hulltrack
