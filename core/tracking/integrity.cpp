#include "core/tracking/integrity.hpp"

#include <cmath>
#include <optional>

namespace hulltrack {
namespace {

constexpr float kBesides = 0.3F;   // m in the plane: as far as a surfel is known to be flat
constexpr float kGrazing = 0.1F;   // sine of 6 deg: below it a range says little about the plane
constexpr double kStepGate = 0.5;  // m: observations farther off the plane belong to something else

/// The nearest ray to a surfel in its plane: how far off the plane it ended, and by how much too deep.
struct RayEnd {
  float offset;  // n . (return - p), m
  float depth;   // return's range minus the plane's along the same ray, m
};

std::optional<RayEnd> nearest_ray(const ScanView& view, const Point& p_L, const Point& n_L) {
  std::optional<RayEnd> best;
  float best2 = kBesides * kBesides;
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
        if (besides2 < best2) {
          best2 = besides2;
          best = RayEnd{along - plane, (1.0F - t) * range};
        }
      }
    }
  }
  return best;
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
    const std::optional<RayEnd> end = nearest_ray(view, point.p_L, n_L);
    if (!end || end->depth < -kBehind) {
      continue;
    }
    const bool confirmed = std::abs(end->offset) <= kPlaneGate;
    ++report.expected;
    report.confirmed += confirmed ? 1 : 0;
    report.seen_through += !confirmed && end->depth > kBehind ? 1 : 0;
    if (surfel.surface != SurfaceClass::other) {
      SurfaceCount& count = report.surfaces[static_cast<std::size_t>(surfel.surface)];
      ++count.expected;
      count.confirmed += confirmed ? 1 : 0;
    }
    if (std::abs(end->offset) <= kStepGate) {
      const Eigen::Vector3d p_W = T_W_H * map.subset_H()[point.index].cast<double>();
      observations_.push_back({p_W, n_W, end->offset});
    }
  }
  report.step = solve_plane_step(observations_, reference_W);
  return report;
}

}  // namespace hulltrack
