// The reference map of one ship: the cloud, its search tree, and all that is derived from it for metrics,
// checks, registration and search.
//
// Frame H, metres. Built once at start-up; immutable, so that threads share it.
// Precondition of the constructor: a non-empty cloud of finite points (core/io checks files).
// Cost: about 1 us a map point; memory about 40 bytes a map point.
#pragma once

#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/geometry/point_blocks.hpp"
#include "core/kdtree/kdtree.hpp"
#include "core/map/landmarks.hpp"
#include "core/map/occupancy_grid.hpp"
#include "core/map/plane_map.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

class HullMap {
 public:
  /// The metric subset has one map point in each voxel of this size (ICD 3).
  static constexpr float kSubsetVoxel = 0.4F;  // m
  /// The occluders, which hide what lies behind them, are one map point in each voxel of this size.
  static constexpr float kOccluderVoxel = 0.15F;  // m

  explicit HullMap(Cloud cloud_H);

  [[nodiscard]] const Cloud& cloud_H() const { return cloud_H_; }
  /// Length of the mapped part of the hull along X, m; > 0.
  [[nodiscard]] double length() const;
  [[nodiscard]] const KdTree& tree() const { return tree_; }

  /// The metric subset, and for each of its points the surface around it; same indices.
  [[nodiscard]] const Cloud& subset_H() const { return subset_H_; }
  [[nodiscard]] const std::vector<Surfel>& surfels() const { return landmarked_.surfels; }

  /// Points on the tops of the hatches' coamings, and the landmarks that rim points and surfels form.
  [[nodiscard]] const std::vector<RimPoint>& rims() const { return landmarked_.rims; }
  [[nodiscard]] const std::vector<Landmark>& landmarks() const { return landmarked_.landmarks; }

  /// The points that are looked for in a scan: first the metric subset, then the rim points.
  [[nodiscard]] const Cloud& probes_H() const { return probes_H_; }

  /// The points that hide others when the map is seen from a sensor.
  [[nodiscard]] const PointBlocks& occluders_H() const { return occluders_H_; }

  /// The flat parts, for registration.
  [[nodiscard]] const PlaneMap& planes() const { return planes_; }
  /// The cells that the hull fills, for searching the whole berth.
  [[nodiscard]] const OccupancyGrid& occupancy() const { return occupancy_; }

 private:
  HullMap(const Relief& relief, Cloud&& cloud_H);

  Cloud cloud_H_;
  KdTree tree_;
  Cloud subset_H_;
  LandmarkedMap landmarked_;
  Cloud probes_H_;
  PointBlocks occluders_H_;
  PlaneMap planes_;
  OccupancyGrid occupancy_;
};

}  // namespace hulltrack
