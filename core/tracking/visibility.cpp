#include "core/tracking/visibility.hpp"

#include <algorithm>
#include <limits>

namespace hulltrack {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;
constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr float kFrontMost = 0.4F;  // m (ICD 3)
// A voxel's representative hides a disc as wide as the voxel; no more cells than this at point-blank range.
constexpr int kLargestSplat = 5;

}  // namespace

void Visibility::run(const HullMap& map, std::span<const Point> candidates_H, const Pose& T_W_H,
                     std::span<const ScanView> views, std::span<const SensorConfig> sensors,
                     std::vector<VisiblePoint>& out) {
  out.clear();
  seen_.assign(candidates_H.size(), false);
  for (std::size_t lidar = 0; lidar < views.size(); ++lidar) {
    const ScanView& view = views[lidar];
    const Pose T_L_H = view.T_W_L().inverse() * T_W_H;
    const Eigen::Matrix3f R = T_L_H.linear().cast<float>();
    const Point t = T_L_H.translation().cast<float>();
    const auto min_range = static_cast<float>(sensors[lidar].min_range);
    const auto range = static_cast<float>(std::min(sensors[lidar].max_range, metric_range_));
    render(map.occluders_H(), R, t, range);
    for (std::uint32_t i = 0; i < candidates_H.size(); ++i) {
      const Point p_L = R * candidates_H[i] + t;
      const float r2 = p_L.squaredNorm();
      if (!(r2 <= range * range && r2 >= min_range * min_range) || seen_[i]) {
        continue;
      }
      const float r = std::sqrt(r2);
      const SphericalGrid::Cell cell = SphericalGrid::cell(p_L);
      if (view.looks_at(cell) && r <= map_nearest_[cell.index()] + kFrontMost && !view.hidden(cell, r)) {
        out.push_back({i, static_cast<std::uint16_t>(lidar), p_L});
        seen_[i] = true;
      }
    }
  }
  if (views.size() > 1) {
    std::sort(out.begin(), out.end(),
              [](const VisiblePoint& a, const VisiblePoint& b) { return a.index < b.index; });
  }
}

void Visibility::render(std::span<const Point> occluders_H, const Eigen::Matrix3f& R_L_H, const Point& t_L_H,
                        float range) {
  cell_nearest_.assign(SphericalGrid::kCells, kNothing);
  for (const Point& p_H : occluders_H) {
    const Point p_L = R_L_H * p_H + t_L_H;
    const float r2 = p_L.squaredNorm();
    if (r2 <= range * range) {
      float& nearest2 = cell_nearest_[SphericalGrid::cell(p_L).index()];
      nearest2 = std::min(nearest2, r2);
    }
  }
  // The nearest occluder of a cell covers the most: the others behind it hide nothing besides.
  map_nearest_.assign(SphericalGrid::kCells, kNothing);
  for (int row = 0; row < SphericalGrid::kRows; ++row) {
    for (int column = 0; column < SphericalGrid::kColumns; ++column) {
      const SphericalGrid::Cell cell{row, column};
      if (cell_nearest_[cell.index()] != kNothing) {
        splat(cell, std::sqrt(cell_nearest_[cell.index()]));
      }
    }
  }
}

void Visibility::splat(SphericalGrid::Cell cell, float r) {
  const float cells_wide = HullMap::kOccluderVoxel / (std::max(r, HullMap::kOccluderVoxel) * kDegree);
  const int reach = std::min(static_cast<int>(cells_wide / 2.0F), kLargestSplat);
  for (int dr = -reach; dr <= reach; ++dr) {
    for (int dc = -reach; dc <= reach; ++dc) {
      float& nearest = map_nearest_[cell.moved(dr, dc).index()];
      nearest = std::min(nearest, r);
    }
  }
}

}  // namespace hulltrack
