// The reference map of one ship: immutable cloud, search tree, and what metrics and checks need of it.
//
// Frame H, metres. Built once at start-up; shared between threads afterwards.
// Precondition of the constructor: a non-empty cloud of finite points (core/io checks files).
// Cost: about 1 us a map point; memory about 40 bytes a map point.
#pragma once

#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/geometry/point_blocks.hpp"
#include "core/kdtree/kdtree.hpp"
#include "core/map/occupancy_grid.hpp"
#include "core/map/patches.hpp"
#include "core/map/plane_map.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

class HullMap {
 public:
  /// One point a voxel of this size is the fixed subset of the metrics (ICD 3).
  static constexpr float kSubsetVoxel = 0.4F;  // m
  /// One point a voxel of this size hides what lies behind it.
  static constexpr float kOccluderVoxel = 0.15F;  // m

  explicit HullMap(Cloud cloud_H);

  [[nodiscard]] const Cloud& cloud_H() const { return cloud_H_; }
  /// Of the hull as far as it is mapped, along X, m; > 0.
  [[nodiscard]] double length() const;
  [[nodiscard]] const KdTree& tree() const { return tree_; }

  /// The metric subset, and for each of its points the surface around it.
  [[nodiscard]] const Cloud& subset_H() const { return subset_H_; }
  [[nodiscard]] const std::vector<Surfel>& surfels() const { return surfels_; }

  /// The tops of the hatches' coamings, and the patches that these and the surfels form.
  [[nodiscard]] const std::vector<RimPoint>& rims() const { return rims_; }
  [[nodiscard]] const std::vector<MapPatch>& patches() const { return patches_; }

  /// What is looked for in a scan: the metric subset, then the rim points.
  [[nodiscard]] const Cloud& probes_H() const { return probes_H_; }

  [[nodiscard]] const PointBlocks& occluders_H() const { return occluders_H_; }

  /// The flat parts, for registration.
  [[nodiscard]] const PlaneMap& planes() const { return planes_; }
  /// For searching the whole berth.
  [[nodiscard]] const OccupancyGrid& occupancy() const { return occupancy_; }

 private:
  Cloud cloud_H_;
  KdTree tree_;
  Cloud subset_H_;
  std::vector<Surfel> surfels_;
  std::vector<RimPoint> rims_;
  std::vector<MapPatch> patches_;  // by number
  Cloud probes_H_;
  PointBlocks occluders_H_;
  Relief relief_;
  PlaneMap planes_;
  OccupancyGrid occupancy_;
};

}  // namespace hulltrack
