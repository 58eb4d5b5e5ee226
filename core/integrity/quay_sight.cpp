#include "core/integrity/quay_sight.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

// Within this of a plane a ray has met it, m.
constexpr float kOnPlane = 0.15F;
constexpr std::array kRarestFirst = {SurfaceClass::transverse, SurfaceClass::longitudinal,
                                     SurfaceClass::other, SurfaceClass::horizontal};

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
                                        std::span<const ScanView> views) {
  begin_frame();
  looked_up_W_.clear();
  take_evenly(scan, kLookedUp, [this](const Point& p) { looked_up_W_.push_back(p); });
  choose_returns_near(map, looked_up_W_, kReturnsOf);
  observe_planes(map);
  for (const ScanView& view : views) {
    for (std::size_t surface = 0; surface < QuayMap::kClasses; ++surface) {
      look_through(map, surface, view);
    }
  }
  return gather();
}

const QuaySighting& QuaySight::look_elsewhere(const QuayMap& map, const Cloud& returns_W,
                                              const Pose& T_true_said, std::size_t of_class) {
  begin_frame();
  const Eigen::Isometry3f moves(T_true_said.cast<float>());
  looked_up_W_.resize(returns_W.size());
  std::transform(returns_W.begin(), returns_W.end(), looked_up_W_.begin(),
                 [&](const Point& p) { return moves * p; });
  OfClass most;
  most.fill(of_class);
  choose_returns_near(map, looked_up_W_, most);
  observe_planes(map);
  return gather();
}

/// What the chosen returns say of the planes that they are near to.
void QuaySight::observe_planes(const QuayMap& map) {
  nearest_.resize(returns_W_.size());
  map.tree().nearest(returns_W_, kGate, nearest_);
  for (std::size_t i = 0; i < returns_W_.size(); ++i) {
    if (nearest_[i].index == Neighbour::kNone) {
      continue;
    }
    const QuayMap::Plane& plane = map.planes()[nearest_[i].index];
    if (plane.holds(returns_W_[i], static_cast<double>(kGate))) {
      observe(plane.surface, returns_W_[i], plane.normal_W.cast<double>(), plane.offset(returns_W_[i]));
    }
  }
}

const QuaySighting& QuaySight::look_for(const QuayPlane& top, const FilteredScan& scan, const Box* area_W) {
  choose_returns(scan);
  const Eigen::Vector3d n_W = top.normal();
  for (const Point& p : returns_W_) {
    if (area_W != nullptr && !beneath_or_above(*area_W, p)) {
      continue;
    }
    ++seen_.asked;
    if (const double offset = top.above(p.cast<double>()); std::abs(offset) <= static_cast<double>(kGate)) {
      observe(SurfaceClass::horizontal, p, n_W, offset);
    }
  }
  return gather();
}

const Cloud& QuaySight::returns_of(const FilteredScan& scan) {
  choose_returns(scan);
  return returns_W_;
}

void QuaySight::forget() {
  for (auto& of_class : recent_) {
    of_class.clear();
  }
}

void QuaySight::observe(SurfaceClass surface, const Point& return_W, const Eigen::Vector3d& n_W,
                        double offset) {
  recent_.at(static_cast<std::size_t>(surface))
      .push_back({turn_, {return_W.cast<double>() - offset * n_W, n_W, offset, surface, 0}});
}

const QuaySighting& QuaySight::gather() {
  seen_.observations.clear();
  for (auto& of_class : recent_) {
    while (!of_class.empty() && (of_class.size() > kOfClass || turn_ - of_class.front().turn >= kFrames)) {
      of_class.pop_front();
    }
    for (const Recent& recent : of_class) {
      seen_.observations.push_back(recent.observation);
      seen_.observations.back().age = turn_ - recent.turn;
    }
  }
  return seen_;
}

void QuaySight::begin_frame() {
  for (QuayCount& count : seen_.planes) {
    count.reached = 0;
    count.seen_through_W.clear();
  }
  returns_W_.clear();
  seen_.asked = 0;
  ++turn_;
}

/// Calls take(p) for `most` returns that may be the quay's at most, evenly out of the scan, others each
/// frame.
template <typename Take>
void QuaySight::take_evenly(const FilteredScan& scan, std::size_t most, Take take) const {
  const ReturnOf wanted = has_region_ ? ReturnOf::surroundings : ReturnOf::hull;
  std::size_t all = 0;
  for (const auto& of : scan.of) {
    all += static_cast<std::size_t>(std::count(of.begin(), of.end(), wanted));
  }
  const std::size_t stride = std::max<std::size_t>(1, (all + most - 1) / most);
  std::size_t number = turn_ % stride;
  for (std::size_t lidar = 0; lidar < scan.of.size(); ++lidar) {
    for (std::size_t i = 0; i < scan.of[lidar].size(); ++i) {
      if (scan.of[lidar][i] == wanted && ++number >= stride) {
        take(scan.returns_W[lidar][i]);
        number = 0;
      }
    }
  }
}

void QuaySight::choose_returns(const FilteredScan& scan) {
  begin_frame();
  take_evenly(scan, kReturns, [this](const Point& p) { returns_W_.push_back(p); });
}

/// Of each class evenly out of those that may be of it; one that may be of several is of the rarest.
void QuaySight::choose_returns_near(const QuayMap& map, const Cloud& looked_up_W, const OfClass& most) {
  for (Cloud& of_class : candidates_W_) {
    of_class.clear();
  }
  for (const Point& p : looked_up_W) {
    const SurfaceCells::Classes classes = map.classes_near(p);
    for (const SurfaceClass surface : kRarestFirst) {
      if ((classes >> static_cast<unsigned>(surface) & 1U) != 0) {
        candidates_W_[static_cast<std::size_t>(surface)].push_back(p);
        break;
      }
    }
  }
  for (std::size_t surface = 0; surface < candidates_W_.size(); ++surface) {
    const Cloud& of_class = candidates_W_[surface];
    const std::size_t stride =
        std::max<std::size_t>(1, (of_class.size() + most[surface] - 1) / most[surface]);
    const std::size_t before = returns_W_.size();
    for (std::size_t i = turn_ % stride; i < of_class.size(); i += stride) {
      returns_W_.push_back(of_class[i]);
    }
    const std::size_t taken = returns_W_.size() - before;
    seen_.each_stands_for[surface] = taken > 0 ? double(of_class.size()) / double(taken) : 1.0;
  }
}

void QuaySight::look_through(const QuayMap& map, std::size_t surface, const ScanView& view) {
  const Point sensor_W = view.T_W_L().translation().cast<float>();
  const Eigen::Matrix3f R_L_W = view.T_W_L().linear().transpose().cast<float>();
  std::size_t near = 0;
  for (const QuayMap::Tile& tile : map.tiles(surface)) {
    near += in_reach(tile, sensor_W) ? tile.count : 0;
  }
  const std::size_t stride = std::max<std::size_t>(1, near / kProbes);
  std::size_t next = turn_ % stride;  // counted over the tiles in reach
  for (const QuayMap::Tile& tile : map.tiles(surface)) {
    if (!in_reach(tile, sensor_W)) {
      continue;
    }
    for (; next < tile.count; next += stride) {
      const QuayMap::Plane& plane = map.planes()[tile.first + next];
      const Point p_L = view.seen(plane.centre_W);
      const SphericalGrid::Cell cell = SphericalGrid::cell(p_L);
      const float range = p_L.norm();
      if (range > kFarthest || !view.looks_at(cell) || view.hidden(cell, range)) {
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
