#include "core/registration/correspondence_cache.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hulltrack {
namespace {

// Searches reach (1 + kMargin) times the gate. A point without a partner may then move by kMargin times the
// gate before it is searched for again.
constexpr float kMargin = 0.3F;

// Searches also bring the target points up to this much farther than the nearest one, m. The first search of
// an alignment brings none of them: the step after it is the largest and would use the margin up.
constexpr float kNeighbourMargin = 0.02F;

// Distances are rounded to float. Bounds are made smaller by this share of the lengths in them, so that
// rounding cannot make a wrong answer.
constexpr float kRounding = 1e-5F;

// The place of a point, computed in float, is off by at most this share of the distances that go into it:
// some ten roundings of 6e-8 each.
constexpr float kRoundingOfPlace = 1e-6F;

// Points that find_awake() looks at together.
constexpr std::size_t kBlock = 64;

}  // namespace

void CorrespondenceCache::Lanes::reset(std::size_t size) {
  for (std::vector<float>* lane : {&x, &y, &z, &searched_x, &searched_y, &searched_z}) {
    lane->assign(size, 0.0F);
  }
  alone.assign(size, -1.0F);
}

// Same float operations as in the tree; of equal distances the lowest index wins, as there.
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
  near_.resize(source.size());
  for (Neighbourhood& near : near_) {
    near.count = 0;
    near.clear_radius = -1.0F;  // nothing is known: the first find() searches
  }
  lanes_.reset((source.size() + kBlock - 1) / kBlock * kBlock);
  farthest_ = 0.0F;
  for (std::size_t i = 0; i < source.size(); ++i) {
    lanes_.x[i] = source[i].x();
    lanes_.y[i] = source[i].y();
    lanes_.z[i] = source[i].z();
    farthest_ = std::max(farthest_, source[i].norm());
  }
}

std::span<const Correspondence> CorrespondenceCache::find(const Pose& T_target_source) {
  find_awake(T_target_source);
  look_up(T_target_source);
  search_unknown();
  pairs_.clear();
  const float squared_gate = gate_ * gate_;
  for (std::size_t a = 0; a < awake_.size(); ++a) {
    const Nearest& nearest = nearest_[a];
    if (nearest.squared_distance < squared_gate) {
      const Neighbourhood& near = near_[awake_[a]];
      pairs_.push_back(
          {places_[a],
           Eigen::Vector3f(near.x[nearest.lane], near.y[nearest.lane], near.z[nearest.lane]).cast<double>(),
           std::sqrt(static_cast<double>(nearest.squared_distance)), near.index[nearest.lane]});
    }
  }
  return pairs_;
}

// Fills awake_ with the points for which the last search does not prove that they have no partner.
void CorrespondenceCache::find_awake(const Pose& T_target_source) {
  const Eigen::Matrix3f R = T_target_source.linear().cast<float>();
  const Eigen::Vector3f t = T_target_source.translation().cast<float>();
  const float rounding = kRoundingOfPlace * (farthest_ + t.norm());
  awake_.clear();
  for (std::size_t block = 0; block < lanes_.x.size(); block += kBlock) {
    std::array<bool, kBlock> awake;
    for (std::size_t lane = 0; lane < kBlock; ++lane) {
      const std::size_t i = block + lane;
      const float x = lanes_.x[i];
      const float y = lanes_.y[i];
      const float z = lanes_.z[i];
      const float dx = R(0, 0) * x + R(0, 1) * y + R(0, 2) * z + t.x() - lanes_.searched_x[i];
      const float dy = R(1, 0) * x + R(1, 1) * y + R(1, 2) * z + t.y() - lanes_.searched_y[i];
      const float dz = R(2, 0) * x + R(2, 1) * y + R(2, 2) * z + t.z() - lanes_.searched_z[i];
      const float alone = lanes_.alone[i] - rounding;
      awake[lane] = !(dx * dx + dy * dy + dz * dz < alone * std::abs(alone));
    }
    for (std::size_t lane = 0; lane < std::min(kBlock, source_.size() - block); ++lane) {
      if (awake[lane]) {
        awake_.push_back(static_cast<std::uint32_t>(block + lane));
      }
    }
  }
}

// Finds the nearest target point of each awake point from its last search, if that proves it to be the
// nearest. The other awake points go to unknown_.
void CorrespondenceCache::look_up(const Pose& T_target_source) {
  const Eigen::Matrix3d R = T_target_source.linear();
  const Eigen::Vector3d t = T_target_source.translation();
  const float squared_gate = gate_ * gate_;
  const float farthest = gate_ * (1.0F + kMargin);
  places_.resize(awake_.size());
  nearest_.resize(awake_.size());
  unknown_.clear();
  queries_.clear();
  radii_.clear();
  for (std::size_t a = 0; a < awake_.size(); ++a) {
    const std::uint32_t i = awake_[a];
    const Neighbourhood& near = near_[i];
    places_[a] = R * source_[i].cast<double>() + t;
    const Point q = places_[a].cast<float>();
    const float moved = (q - lanes_.searched(i)).norm();
    const float clear = near.clear_radius;
    const float reach = clear - moved - kRounding * (clear + moved);
    nearest_[a] = near.count > 0 ? nearest_of(near, q) : Nearest{};
    const bool known = reach > 0.0F && std::min(nearest_[a].squared_distance, squared_gate) < reach * reach;
    if (!known) {
      unknown_.push_back(static_cast<std::uint32_t>(a));
      queries_.push_back(q);
      // The nearest point is at most as far away as the nearest known one: a bound for the search.
      const float bound = std::sqrt(nearest_[a].squared_distance) + kNeighbourMargin;
      radii_.push_back(std::min(bound, farthest));
    }
  }
}

void CorrespondenceCache::search_unknown() {
  answers_.resize(std::max(answers_.size(), queries_.size()));
  target_->neighbourhoods(queries_, radii_, margin_, std::span(answers_).first(queries_.size()));
  for (std::size_t u = 0; u < unknown_.size(); ++u) {
    const std::uint32_t a = unknown_[u];
    const std::uint32_t i = awake_[a];
    near_[i] = answers_[u];
    nearest_[a] = answers_[u].count > 0 ? nearest_of(answers_[u], queries_[u]) : Nearest{};
    const float clear = std::min(std::sqrt(nearest_[a].squared_distance), answers_[u].clear_radius);
    lanes_.searched_x[i] = queries_[u].x();
    lanes_.searched_y[i] = queries_[u].y();
    lanes_.searched_z[i] = queries_[u].z();
    lanes_.alone[i] = clear - gate_ - kRounding * clear;
  }
  searches_ += unknown_.size();
  margin_ = kNeighbourMargin;
}

}  // namespace hulltrack
