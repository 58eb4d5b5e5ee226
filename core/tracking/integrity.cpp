#include "core/tracking/integrity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hulltrack {
namespace {

constexpr float kBesides = 0.3F;  // m in the plane: as far as a surfel is known to be flat
constexpr float kAround = 0.2F;   // m in the plane: half a subset voxel; returns in it are the surfel's own
constexpr float kSameSurface = 0.06F;  // m: three sigma of a return beside the nearest one
constexpr float kGrazing = 0.1F;       // sine of 6 deg: below it a range says little about the plane
constexpr float kStepGate = 0.5F;      // m: observations farther off the plane belong to something else
// Returns of one surfel share the map's error there (5 mm) beside their own (20 mm).
constexpr float kSharedError = 1.0F / 16.0F;

/// Every ray that meets the plane within kBesides of the surfel.
void collect_rays(const ScanView& view, const Point& p_L, const Point& n_L, std::vector<RayEnd>& rays) {
  rays.clear();
  const SphericalGrid::Cell centre = SphericalGrid::cell(p_L);
  const float plane = n_L.dot(p_L);
  for (int dr = -1; dr <= 1; ++dr) {
    for (int dc = -1; dc <= 1; ++dc) {
      for (const Point& s : view.returns(centre.moved(dr, dc))) {
        const float along = n_L.dot(s);
        const float range = s.norm();
        if (std::abs(along) < kGrazing * range) {
          continue;
        }
        const float t = plane / along;  // the plane is met at t * s
        const float besides2 = (t * s - p_L).squaredNorm();
        if (besides2 < kBesides * kBesides) {
          rays.push_back({besides2, along - plane, (1.0F - t) * range});
        }
      }
    }
  }
}

/// Mean offset and worth of the returns that lie on the same surface as the nearest ray's.
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

}  // namespace

IntegrityReport Integrity::run(const HullMap& map, std::span<const VisiblePoint> visible, const Pose& T_W_H,
                               std::span<const ScanView> views, const Eigen::Vector3d& reference_W) {
  IntegrityReport report;
  observations_.clear();
  for (const VisiblePoint& point : visible) {
    const Surfel& surfel = map.surfels()[point.index];
    if (!surfel.planar) {
      continue;
    }
    const ScanView& view = views[point.lidar];
    const Eigen::Vector3d n_W = T_W_H.linear() * surfel.normal_H.cast<double>();
    const Point n_L = (view.T_W_L().linear().transpose() * n_W).cast<float>();
    collect_rays(view, point.p_L, n_L, rays_);
    const auto nearest = std::min_element(
        rays_.begin(), rays_.end(), [](const RayEnd& a, const RayEnd& b) { return a.besides2 < b.besides2; });
    if (nearest == rays_.end() || nearest->depth < -kBehind) {
      continue;
    }
    const bool confirmed = std::abs(nearest->offset) <= kPlaneGate;
    ++report.expected;
    report.confirmed += confirmed ? 1 : 0;
    report.seen_through += !confirmed && nearest->depth > kBehind ? 1 : 0;
    if (surfel.surface != SurfaceClass::other) {
      SurfaceCount& count = report.surfaces[static_cast<std::size_t>(surfel.surface)];
      ++count.expected;
      count.confirmed += confirmed ? 1 : 0;
    }
    if (std::abs(nearest->offset) <= kStepGate) {
      const Eigen::Vector3d p_W = T_W_H * map.subset_H()[point.index].cast<double>();
      const auto [offset, weight] = mean_offset(rays_, *nearest);
      observations_.push_back({p_W, n_W, offset, weight});
    }
  }
  report.step = solve_plane_step(observations_, reference_W);
  return report;
}

}  // namespace hulltrack
