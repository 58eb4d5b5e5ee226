#include "core/map/plane_map.hpp"

#include <array>
#include <cmath>
#include <map>

#include "core/filter/voxel_filter.hpp"
#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

// A surface in a hold that is steeper than this stays bare: the steepest heaps of cargo slope by 40 deg.
const float kBareCosine = std::cos(0.87F);  // 50 deg

/// Whether something else may be found in the surfel's place on the same ship on another day: cargo on a
/// level surface in a hold, a hatch cover in the covers' place.
bool may_change(const Surfel& surfel, const Relief& relief) {
  const bool lies = std::abs(surfel.normal_H.z()) > kBareCosine;
  return (lies && relief.in_hold(surfel.centre_H)) || relief.in_covers_place(surfel.centre_H);
}

std::vector<PlaneMap::Plane> find_planes(const Cloud& cloud_H, const KdTree& map, const Relief& relief) {
  Cloud points_H;
  VoxelFilter(PlaneMap::kSpacing).filter(cloud_H, points_H);
  std::vector<PlaneMap::Plane> planes;
  for (const Surfel& surfel : compute_surfels(points_H, map)) {
    if (surfel.planar && !may_change(surfel, relief)) {
      planes.push_back({surfel.centre_H, surfel.normal_H, surfel.surface, 0});
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

/// Numbers the clusters in the order of their first plane; returns how many there are.
std::uint32_t number_clusters(std::vector<PlaneMap::Plane>& planes) {
  std::map<std::array<int, 4>, std::uint32_t> numbers;
  for (PlaneMap::Plane& plane : planes) {
    const auto cell = [&plane](int axis) {
      return static_cast<int>(std::floor(plane.centre_H[axis] / PlaneMap::kClusterSize));
    };
    const std::array<int, 4> key{cell(0), cell(1), cell(2), static_cast<int>(plane.surface)};
    plane.cluster = numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size())).first->second;
  }
  return static_cast<std::uint32_t>(numbers.size());
}

}  // namespace

PlaneMap::PlaneMap(const Cloud& cloud_H, const KdTree& map, const Relief& relief)
    : planes_(find_planes(cloud_H, map, relief)),
      clusters_(number_clusters(planes_)),
      tree_(centres_of(planes_)) {}

}  // namespace hulltrack
