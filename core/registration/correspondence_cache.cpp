#include "core/registration/correspondence_cache.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hulltrack {
namespace {

// Searches look this share of the gate beyond it, so that points without a partner may move that far
// before they are searched for again.
constexpr float kMargin = 0.3F;

// Searches bring the points this much farther than the nearest one as well, m. The first search of an
// alignment does not: the first step is the largest and would use the margin up.
constexpr float kNeighbourMargin = 0.02F;

// Distances are rounded to float: a bound is believed only up to this share of the lengths in it.
constexpr float kRounding = 1e-5F;

}  // namespace

// Same float operations as the tree's own; equal distances go to the lowest index.
CorrespondenceCache::Nearest CorrespondenceCache::nearest_of(const Neighbourhood& near, const Point& q) {
  std::array<float, Neighbourhood::kCapacity> squared;
  for (std::size_t i = 0; i < squared.size(); ++i) {
    const float dx = near.x[i] - q.x();
    const float dy = near.y[i] - q.y();
    const float dz = near.z[i] - q.z();
    squared[i] = (dx * dx + dy * dy) + dz * dz;
  }
  Nearest best{squared[0], 0};
  for (std::uint32_t i = 1; i < near.count; ++i) {
    if (squared[i] < best.squared_distance ||
        (squared[i] == best.squared_distance && near.index[i] < near.index[best.lane])) {
      best = {squared[i], i};
    }
  }
  return best;
}

void CorrespondenceCache::reset(std::span<const Point> source, const KdTree& target) {
  source_ = source;
  target_ = &target;
  searches_ = 0;
  margin_ = 0.0F;
  places_.resize(source.size());
  nearest_.resize(source.size());
  entries_.resize(source.size());
  for (Entry& entry : entries_) {
    entry.near.count = 0;
    entry.near.clear_radius = -1.0F;  // nothing is known: the first find() searches
    entry.searched_at = Point::Zero();
  }
}

std::span<const Correspondence> CorrespondenceCache::find(const Pose& T_target_source) {
  place_source(T_target_source);
  look_up();
  search_unknown();
  pairs_.clear();
  const float squared_gate = gate_ * gate_;
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Nearest& nearest = nearest_[i];
    if (nearest.squared_distance < squared_gate) {
      const Neighbourhood& near = entries_[i].near;
      pairs_.push_back(
          {places_[i],
           Eigen::Vector3f(near.x[nearest.lane], near.y[nearest.lane], near.z[nearest.lane]).cast<double>(),
           std::sqrt(static_cast<double>(nearest.squared_distance))});
    }
  }
  return pairs_;
}

void CorrespondenceCache::place_source(const Pose& T_target_source) {
  const Eigen::Matrix3d R = T_target_source.linear();
  const Eigen::Vector3d t = T_target_source.translation();
  for (std::size_t i = 0; i < source_.size(); ++i) {
    places_[i] = R * source_[i].cast<double>() + t;
  }
}

// Answers what can be answered from the last searches, lists the others in unknown_.
void CorrespondenceCache::look_up() {
  const float squared_gate = gate_ * gate_;
  const float farthest = gate_ * (1.0F + kMargin);
  unknown_.clear();
  queries_.clear();
  radii_.clear();
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const Entry& entry = entries_[i];
    const Point q = places_[i].cast<float>();
    const float moved = (q - entry.searched_at).norm();
    const float clear = entry.near.clear_radius;
    const float reach = clear - moved - kRounding * (clear + moved);
    nearest_[i] = entry.near.count > 0 ? nearest_of(entry.near, q) : Nearest{};
    const bool known = reach > 0.0F && std::min(nearest_[i].squared_distance, squared_gate) < reach * reach;
    if (!known) {
      unknown_.push_back(static_cast<std::uint32_t>(i));
      queries_.push_back(q);
      // The nearest one is at most as far away as the one known, which bounds the search from its start.
      const float bound = std::sqrt(nearest_[i].squared_distance) + kNeighbourMargin;
      radii_.push_back(std::min(bound, farthest));
    }
  }
}

void CorrespondenceCache::search_unknown() {
  answers_.resize(std::max(answers_.size(), queries_.size()));
  target_->neighbourhoods(queries_, radii_, margin_, std::span(answers_).first(queries_.size()));
  for (std::size_t u = 0; u < unknown_.size(); ++u) {
    Entry& entry = entries_[unknown_[u]];
    entry.near = answers_[u];
    entry.searched_at = queries_[u];
    nearest_[unknown_[u]] = entry.near.count > 0 ? nearest_of(entry.near, queries_[u]) : Nearest{};
  }
  searches_ += unknown_.size();
  margin_ = kNeighbourMargin;
}

}  // namespace hulltrack
