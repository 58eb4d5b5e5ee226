#include "core/sight/surface_rays.hpp"

#include <algorithm>
#include <cmath>

#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

using namespace surface_rays;

constexpr float kAround = 0.2F;  // m in the plane: half a subset voxel; returns in it are the surfel's own
// Variance of the error that returns of one surfel share, in units of a return's own: the map's error there
// is 5 mm, a return's 20 mm, and (5 / 20)^2 = 1 / 16.
constexpr float kSharedError = 1.0F / 16.0F;

}  // namespace

void collect_rays(const ScanView& view, const Point& p_L, const Point& n_L, std::vector<RayEnd>& rays) {
  rays.clear();
  const float plane = n_L.dot(p_L);
  view.visit_around(SphericalGrid::cell(p_L), [&](const Point& s) {
    const float along = n_L.dot(s);
    const float range = s.norm();
    if (std::abs(along) < kGrazing * range) {
      return;
    }
    const float t = plane / along;  // the plane is met at t * s
    const float besides2 = (t * s - p_L).squaredNorm();
    const float depth = (1.0F - t) * range;
    const bool stopped = depth < -kBehind;  // by a raindrop, say: it tells nothing of the plane
    if (besides2 < kSurfelRadius * kSurfelRadius && !stopped) {
      rays.push_back({besides2, along - plane, depth});
    }
  });
}

const RayEnd* nearest_ray(const std::vector<RayEnd>& rays) {
  const auto nearest = std::min_element(
      rays.begin(), rays.end(), [](const RayEnd& a, const RayEnd& b) { return a.besides2 < b.besides2; });
  return nearest == rays.end() ? nullptr : &*nearest;
}

std::pair<double, double> mean_offset(const std::vector<RayEnd>& rays, const RayEnd& nearest) {
  double sum = nearest.offset;
  double count = 1.0;
  for (const RayEnd& ray : rays) {
    const bool other = &ray != &nearest;
    if (other && ray.besides2 < kAround * kAround && std::abs(ray.offset - nearest.offset) < kSameSurface) {
      sum += ray.offset;
      count += 1.0;
    }
  }
  return {sum / count, count / (1.0 + count * kSharedError)};
}

}  // namespace hulltrack
