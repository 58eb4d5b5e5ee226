#include "core/quay/quay_sight.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace hulltrack {
namespace {

// A ray that ends within this of a plane, along its normal, has not passed through it, m.
constexpr float kOnPlane = 0.15F;

/// Index of the next return of kind `wanted` from `from` on, or the size. memchr is fast over the long runs
/// of returns of the ship.
std::size_t next_of(ReturnOf wanted, const std::vector<ReturnOf>& of, std::size_t from) {
  static_assert(sizeof(ReturnOf) == 1);
  const void* found =
      from < of.size() ? std::memchr(&of[from], static_cast<int>(wanted), of.size() - from) : nullptr;
  return found != nullptr ? static_cast<std::size_t>(static_cast<const ReturnOf*>(found) - of.data())
                          : of.size();
}

bool in_reach(const QuayMap::Tile& tile, const Point& sensor_W) {
  const float reach = QuaySight::kFarthest + tile.radius;
  return (tile.middle_W - sensor_W).squaredNorm() < reach * reach;
}

bool beneath_or_above(const Box& area_W, const Point& p) {
  return p.x() >= area_W.min.x() && p.x() <= area_W.max.x() && p.y() >= area_W.min.y() &&
         p.y() <= area_W.max.y();
}

}  // namespace

const QuaySighting& QuaySight::look_for(const QuayMap& map, const FilteredScan& scan,
                                        std::span<const ScanView> views, const Pose& E) {
  begin_frame(scan, kLookedUp);
  seen_.observed = &observer_.observe(map, returns_W_, kReturnsOf);
  for (const ScanView& view : views) {
    for (std::size_t surface = 0; surface < QuayMap::kClasses; ++surface) {
      look_through(map, surface, view, E.cast<float>());
    }
  }
  return seen_;
}

const QuaySighting& QuaySight::look_for(const QuayPlane& top, const FilteredScan& scan, const Box* area_W) {
  begin_frame(scan, kReturns);
  if (area_W != nullptr) {
    std::erase_if(returns_W_, [area_W](const Point& p) { return !beneath_or_above(*area_W, p); });
  }
  seen_.asked = returns_W_.size();
  seen_.observed = &observer_.observe(top, returns_W_);
  return seen_;
}

const Cloud& QuaySight::returns_of(const FilteredScan& scan) {
  begin_frame(scan, kReturns);
  observer_.forget();
  return returns_W_;
}

/// Clears the counts, and picks at most `most` returns that may be the quay's: evenly spaced in the scan,
/// different ones each frame.
void QuaySight::begin_frame(const FilteredScan& scan, std::size_t most) {
  for (QuayCount& count : seen_.planes) {
    count.reached = 0;
    count.seen_through_W.clear();
  }
  seen_.asked = 0;
  ++turn_;
  returns_W_.clear();
  const ReturnOf wanted = has_region_ ? ReturnOf::surroundings : ReturnOf::hull;
  std::size_t all = 0;
  for (const auto& of : scan.of) {
    all += static_cast<std::size_t>(std::count(of.begin(), of.end(), wanted));
  }
  const std::size_t stride = std::max<std::size_t>(1, (all + most - 1) / most);
  std::size_t number = turn_ % stride;
  for (std::size_t lidar = 0; lidar < scan.of.size(); ++lidar) {
    const std::vector<ReturnOf>& of = scan.of[lidar];
    for (std::size_t i = next_of(wanted, of, 0); i < of.size(); i = next_of(wanted, of, i + 1)) {
      if (++number >= stride) {
        returns_W_.push_back(scan.returns_W[lidar][i]);
        number = 0;
      }
    }
  }
}

/// Counts the map's planes of one class that one LiDAR's rays reached, and those that they passed through.
void QuaySight::look_through(const QuayMap& map, std::size_t surface, const ScanView& view,
                             const Eigen::Isometry3f& E) {
  const Point sensor_W = view.T_W_L().translation().cast<float>();
  const Eigen::Matrix3f R_L_W = view.T_W_L().linear().transpose().cast<float>();
  std::size_t near = 0;
  for (const QuayMap::Tile& tile : map.tiles(surface)) {
    near += in_reach(tile, sensor_W) ? tile.count : 0;
  }
  const std::size_t stride = std::max<std::size_t>(1, near / kProbes);
  std::size_t next = turn_ % stride;  // index within the tile; the stride goes on from tile to tile
  for (const QuayMap::Tile& tile : map.tiles(surface)) {
    if (!in_reach(tile, sensor_W)) {
      continue;
    }
    for (; next < tile.count; next += stride) {
      const QuayMap::Plane& plane = map.planes()[tile.first + next];
      const Point p_L = view.seen(E * plane.centre_W);
      const float range = p_L.norm();
      if (range > kFarthest) {
        continue;
      }
      const int row = SphericalGrid::row(p_L);
      if (row < view.lowest_row() || row > view.highest_row()) {
        continue;  // most planes are above or below what the lasers reach
      }
      const SphericalGrid::Cell cell{row, SphericalGrid::column(p_L.x(), p_L.y())};
      if (!view.looks_at(cell) || view.hidden(cell, range)) {
        continue;
      }
      collect_rays(view, p_L, R_L_W * plane.normal_W, rays_);
      if (const RayEnd* nearest = nearest_ray(rays_)) {
        const bool through = std::abs(nearest->offset) > kOnPlane && nearest->depth > surface_rays::kBehind;
        seen_.planes[surface].reached += 1;
        if (through) {
          seen_.planes[surface].seen_through_W.push_back(plane.centre_W);
        }
      }
    }
    next -= tile.count;
  }
}

}  // namespace hulltrack
