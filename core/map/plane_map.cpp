#include "core/map/plane_map.hpp"

#include "core/filter/voxel_filter.hpp"
#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

std::vector<PlaneMap::Plane> find_planes(const Cloud& cloud_H, const KdTree& map) {
  Cloud points_H;
  VoxelFilter(PlaneMap::kSpacing).filter(cloud_H, points_H);
  std::vector<PlaneMap::Plane> planes;
  for (const Surfel& surfel : compute_surfels(points_H, cloud_H, map)) {
    if (surfel.planar) {
      planes.push_back({surfel.centre_H, surfel.normal_H, surfel.surface});
    }
  }
  return planes;
}

Cloud centres_of(const std::vector<PlaneMap::Plane>& planes) {
  Cloud centres_H;
  centres_H.reserve(planes.size());
  for (const PlaneMap::Plane& plane : planes) {
    centres_H.push_back(plane.centre_H);
  }
  return centres_H;
}

}  // namespace

PlaneMap::PlaneMap(const Cloud& cloud_H, const KdTree& map)
    : planes_(find_planes(cloud_H, map)), tree_(centres_of(planes_)) {}

}  // namespace hulltrack
