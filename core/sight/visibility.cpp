#include "core/sight/visibility.hpp"

#include <algorithm>
#include <limits>

#include "core/geometry/sighting.hpp"

namespace hulltrack {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;
constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();
constexpr float kFrontMost = 0.4F;  // m (ICD 3)
// An occluder covers as many cells as its voxel spans, but at point-blank range no more than this to each
// side.
constexpr int kLargestSplat = 5;

}  // namespace

void keep_within(double range, std::vector<VisiblePoint>& visible) {
  const auto most = static_cast<float>(range);
  std::erase_if(visible, [&](const VisiblePoint& p) { return !(p.p_L.squaredNorm() <= most * most); });
}

void Visibility::run(const HullMap& map, std::span<const Point> candidates_H, const Pose& T_W_H,
                     std::span<const ScanView> views, std::span<const SensorConfig> sensors,
                     std::vector<VisiblePoint>& out) {
  out.clear();
  place_.assign(candidates_H.size(), kNowhere);
  for (std::size_t lidar = 0; lidar < views.size(); ++lidar) {
    const ScanView& view = views[lidar];
    const Pose T_L_H = view.T_W_L().inverse() * T_W_H;
    const auto min_range = static_cast<float>(sensors[lidar].min_range);
    const auto range = static_cast<float>(std::min(sensors[lidar].max_range, farthest_));
    // Rows just outside the field of view count too: an occluder covers up to kLargestSplat rows beyond its
    // own.
    render(map.occluders_H(), T_L_H,
           {range, view.lowest_row() - kLargestSplat, view.highest_row() + kLargestSplat});
    sight(candidates_H, T_L_H, [&](std::size_t candidate, const Sightings& from_L, std::size_t i) {
      const float r2 = from_L.range2[i];
      if (!(r2 <= range * range && r2 >= min_range * min_range)) {
        return;
      }
      const float r = std::sqrt(r2);
      const SphericalGrid::Cell cell = SphericalGrid::at(from_L.cell[i]);
      if (view.looks_at(cell) && r <= map_nearest_[cell.index()] + kFrontMost && !view.hidden(cell, r)) {
        const VisiblePoint seen{static_cast<std::uint32_t>(candidate), static_cast<std::uint16_t>(lidar),
                                from_L.point(i)};
        std::uint32_t& place = place_[candidate];
        if (place == kNowhere) {
          place = static_cast<std::uint32_t>(out.size());
          out.push_back(seen);
        } else if (r2 < out[place].p_L.squaredNorm()) {
          out[place] = seen;
        }
      }
    });
  }
  if (views.size() > 1) {
    std::sort(out.begin(), out.end(),
              [](const VisiblePoint& a, const VisiblePoint& b) { return a.index < b.index; });
  }
}

void Visibility::render(const PointBlocks& occluders_H, const Pose& T_L_H, const SightLimits& limits) {
  cell_nearest_.assign(SphericalGrid::kCells, kNothing);
  const float range2 = limits.range * limits.range;
  occluders_H.sight_within(limits, T_L_H, [&](const Sightings& from_L, std::size_t i) {
    float& nearest2 = cell_nearest_[from_L.cell[i]];
    nearest2 = std::min(nearest2, from_L.range2[i] <= range2 ? from_L.range2[i] : kNothing);
  });
  // Only the nearest occluder of a cell is spread over its neighbours: it covers the most cells, and those
  // behind it hide nothing that it does not hide.
  map_nearest_.assign(SphericalGrid::kCells, kNothing);
  const int lowest = std::max(limits.lowest_row, 0);
  const int highest = std::min(limits.highest_row, SphericalGrid::kRows - 1);
  for (int row = lowest; row <= highest; ++row) {
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
  if (reach == 0) {
    map_nearest_[cell.index()] = std::min(map_nearest_[cell.index()], r);
    return;
  }
  for (int dr = -reach; dr <= reach; ++dr) {
    for (int dc = -reach; dc <= reach; ++dc) {
      float& nearest = map_nearest_[cell.moved(dr, dc).index()];
      nearest = std::min(nearest, r);
    }
  }
}

}  // namespace hulltrack
