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

Cloud joined(Cloud points, const std::vector<RimPoint>& rims) {
  for (const RimPoint& rim : rims) {
    points.push_back(rim.p_H);
  }
  return points;
}

}  // namespace

HullMap::HullMap(Cloud cloud_H) : HullMap(Relief(cloud_H), std::move(cloud_H)) {}

HullMap::HullMap(const Relief& relief, Cloud&& cloud_H)
    : cloud_H_(std::move(cloud_H)),
      tree_(cloud_H_),
      subset_H_(thinned(cloud_H_, kSubsetVoxel)),
      landmarked_(find_landmarks(subset_H_, tree_, relief,
                                 oriented_surfels(subset_H_, tree_, compute_surfels(subset_H_, tree_)),
                                 find_rims(cloud_H_, tree_, relief))),
      probes_H_(joined(subset_H_, landmarked_.rims)),
      occluders_H_(thinned(cloud_H_, kOccluderVoxel)),
      planes_(cloud_H_, tree_, relief),
      occupancy_(subset_H_) {}

double HullMap::length() const {
  constexpr float kShortest = 1.0F;  // m: a map of one point has a length, too
  const Box box = bounding_box(subset_H_);
  return static_cast<double>(std::max(kShortest, box.max.x() - box.min.x()));
}

}  // namespace hulltrack
