#include "core/map/hull_map.hpp"

#include <algorithm>

#include "core/filter/voxel_filter.hpp"
#include "core/geometry/box.hpp"
#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

Cloud thinned(const Cloud& cloud, float voxel) {
  Cloud out;
  VoxelFilter(voxel).filter(cloud, out);
  return out;
}

}  // namespace

HullMap::HullMap(Cloud cloud_H)
    : cloud_H_(std::move(cloud_H)),
      tree_(cloud_H_),
      subset_H_(thinned(cloud_H_, kSubsetVoxel)),
      surfels_(compute_surfels(subset_H_, tree_)),
      occluders_H_(thinned(cloud_H_, kOccluderVoxel)),
      relief_(cloud_H_),
      planes_(cloud_H_, tree_, relief_),
      occupancy_(subset_H_) {
  orient_surfels(subset_H_, tree_, surfels_);
  rims_ = find_rims(cloud_H_, tree_, relief_);
  landmarks_ = find_landmarks(subset_H_, tree_, relief_, surfels_, rims_);
  probes_H_ = subset_H_;
  for (const RimPoint& rim : rims_) {
    probes_H_.push_back(rim.p_H);
  }
}

double HullMap::length() const {
  constexpr float kShortest = 1.0F;  // m: a map of one point has a length, too
  const Box box = bounding_box(subset_H_);
  return static_cast<double>(std::max(kShortest, box.max.x() - box.min.x()));
}

}  // namespace hulltrack
