#include "core/sight/expected_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
static_assert(SphericalGrid::kColumns == 360 && SphericalGrid::kRows == 180);
constexpr float kSineOfCell = 0.01745F;  // one degree

/// Squared distance from a surfel to where the nearest ray meets its plane, m^2. Only the rays of the
/// surfel's cell and the eight around it are tried, and a ray counts only within kSurfelRadius, where the map
/// is flat. If none counts, the answer is how far off all rays are at least: kSurfelRadius, or one degree of
/// azimuth or elevation (rays of other cells) if that is less.
float nearest_ray2(const ScanView& view, const Point& p_L, const Point& n_L) {
  const float plane = n_L.dot(p_L);
  float nearest2 = kNone;
  view.visit_around(SphericalGrid::cell(p_L), [&](const Point& returned) {
    const Point met = plane / n_L.dot(returned) * returned;
    // Of a ray parallel to the plane this is infinity or NaN; against NaN min() keeps its first argument.
    nearest2 = std::min(nearest2, (met - p_L).squaredNorm());
  });
  const float looked = std::min(kSurfelRadius, p_L.head<2>().norm() * kSineOfCell);
  return nearest2 <= kSurfelRadius * kSurfelRadius ? nearest2 : looked * looked;
}

}  // namespace

std::optional<double> ExpectedDistance::q1(const HullMap& map, std::span<const VisiblePoint> visible,
                                           const Pose& T_W_H, std::span<const ScanView> views) {
  between2_.clear();
  const std::size_t stride = visible.size() / kSamples + 1;
  for (std::size_t i = 0; i < visible.size(); i += stride) {
    const VisiblePoint& point = visible[i];
    if (point.index >= map.surfels().size() || !map.surfels()[point.index].planar) {
      continue;
    }
    const Eigen::Vector3d n_W = T_W_H.linear() * map.surfels()[point.index].normal_H.cast<double>();
    const Eigen::Vector3d p_W = T_W_H * map.subset_H()[point.index].cast<double>();
    float nearest2 = kNone;
    for (std::size_t lidar = 0; lidar < views.size(); ++lidar) {
      const ScanView& view = views[lidar];
      const Pose T_L_W = view.T_W_L().inverse();
      const Point p_L = (T_L_W * p_W).cast<float>();
      if (lidar == point.lidar || !view.hidden(SphericalGrid::cell(p_L), p_L.norm())) {
        nearest2 = std::min(nearest2, nearest_ray2(view, p_L, (T_L_W.linear() * n_W).cast<float>()));
      }
    }
    between2_.push_back(nearest2);
  }
  if (had_few_surfels()) {
    return std::nullopt;
  }
  const auto quartile = between2_.begin() + static_cast<std::ptrdiff_t>(between2_.size() / 4);
  std::nth_element(between2_.begin(), quartile, between2_.end());
  return std::sqrt(static_cast<double>(*quartile) + kRangeNoise * kRangeNoise);
}

}  // namespace hulltrack
