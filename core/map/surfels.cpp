#include "core/map/surfels.hpp"

#include <cmath>

#include "core/map/plane_fit.hpp"

namespace hulltrack {
namespace {

constexpr std::size_t kFewestNeighbours = 8;
constexpr double kFlat = 0.025;        // m: largest RMS distance from the plane; map noise and voxel size
constexpr double kNarrow = 0.08;       // m: smallest RMS extent in the plane; a full disc has r / 2 = 0.15
constexpr double kOffCentre = 0.06;    // m: largest distance of the centroid; half disc: 4 r / (3 pi) = 0.13
constexpr float kClassCosine = 0.85F;  // 31.8 deg

SurfaceClass classify(const Point& n) {
  for (std::size_t axis = 0; axis < kSurfaceClasses; ++axis) {
    if (std::abs(n[static_cast<Eigen::Index>(axis)]) > kClassCosine) {
      return static_cast<SurfaceClass>(axis);
    }
  }
  return SurfaceClass::other;
}

Surfel surfel_of(const Point& p, const Cloud& neighbours) {
  if (neighbours.size() < kFewestNeighbours) {
    return {};
  }
  const PlaneFit fit = fit_plane(p, neighbours);
  Surfel surfel;
  surfel.normal_H = fit.normal.cast<float>();
  surfel.centre_H = p + fit.centroid.cast<float>();
  surfel.surface = classify(surfel.normal_H);
  surfel.planar = fit.spread[0] < kFlat && fit.spread[1] > kNarrow && fit.centroid.norm() < kOffCentre;
  return surfel;
}

}  // namespace

std::vector<Surfel> compute_surfels(const Cloud& points_H, const KdTree& map) {
  std::vector<Surfel> surfels;
  surfels.reserve(points_H.size());
  Cloud neighbours;
  for (const Point& p : points_H) {
    map.within(p, kSurfelRadius, neighbours);
    surfels.push_back(surfel_of(p, neighbours));
  }
  return surfels;
}

}  // namespace hulltrack
