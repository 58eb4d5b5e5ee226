#include "core/registration/correspondence_cache.hpp"

#include <cmath>

namespace hulltrack {
namespace {

// Searches look this share of the gate beyond it, so that points without a partner may move that far
// before they are searched for again.
constexpr float kMargin = 0.3F;

// Distances are rounded to float: a bound is believed only up to this share of the lengths in it.
constexpr float kRounding = 1e-5F;

struct Nearest {
  float squared_distance;
  std::size_t lane;
};

// The nearest of the few, ties by index. Same float operations as the tree's own.
Nearest nearest_of(const Neighbourhood& near, const Point& q) {
  std::array<float, Neighbourhood::kCapacity> squared;
  for (std::size_t i = 0; i < squared.size(); ++i) {
    const float dx = near.x[i] - q.x();
    const float dy = near.y[i] - q.y();
    const float dz = near.z[i] - q.z();
    squared[i] = (dx * dx + dy * dy) + dz * dz;
  }
  Nearest best{squared[0], 0};
  for (std::size_t i = 1; i < near.count; ++i) {
    if (squared[i] < best.squared_distance ||
        (squared[i] == best.squared_distance && near.index[i] < near.index[best.lane])) {
      best = {squared[i], i};
    }
  }
  return best;
}

}  // namespace

void CorrespondenceCache::reset(std::span<const Point> source, const KdTree& target) {
  source_ = source;
  target_ = &target;
  searches_ = 0;
  entries_.resize(source.size());
  for (Entry& entry : entries_) {
    entry.near.x.fill(std::numeric_limits<float>::infinity());
    entry.near.count = 0;
    entry.near.clear_radius = -1.0F;  // nothing is known: the first find() searches
    entry.searched_at = Point::Zero();
  }
}

std::span<const Correspondence> CorrespondenceCache::find(const Pose& T_target_source) {
  const float squared_gate = gate_ * gate_;
  pairs_.clear();
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Eigen::Vector3d place = T_target_source * source_[i].cast<double>();
    const Point q = place.cast<float>();
    if (!q.allFinite()) {
      continue;
    }
    Entry& entry = entries_[i];
    Nearest nearest = nearest_of(entry.near, q);
    const float moved = (q - entry.searched_at).norm();
    const float reach = entry.near.clear_radius - moved - kRounding * (entry.near.clear_radius + moved);
    const bool known = reach > 0.0F && std::min(nearest.squared_distance, squared_gate) < reach * reach;
    if (!known) {
      target_->neighbourhood(q, gate_ * (1.0F + kMargin), entry.near);
      entry.searched_at = q;
      ++searches_;
      nearest = nearest_of(entry.near, q);
    }
    if (nearest.squared_distance < squared_gate) {
      const std::size_t lane = nearest.lane;
      const Point target(entry.near.x[lane], entry.near.y[lane], entry.near.z[lane]);
      pairs_.push_back(
          {place, target.cast<double>(), std::sqrt(static_cast<double>(nearest.squared_distance))});
    }
  }
  return pairs_;
}

}  // namespace hulltrack
