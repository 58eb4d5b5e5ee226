#include "core/localisation/hull_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hulltrack {
namespace {

constexpr double kCell = OccupancyGrid::kCell;

// Shifts that a search keeps as starts. A scan of one hatch fits each of the ship's handful of hatches, and
// also beside them, shifted by the spacing of her ribs.
constexpr std::size_t kMostStarts = 12;
// A shift less than this many cells from a better one, along every axis, is the same start.
constexpr int kApart = 3;

// Shifts that are tried after an approach. Few surfaces hold it along the ship, or across her where little
// but decks is in view: it may stop farther off than a fine alignment reaches.
constexpr std::array<double, 4> kSlides{-0.4, -0.2, 0.2, 0.4};  // m

// Stretches of the berth that challenge() tries in turn, one a call. Hatches are 15 to 35 m apart, so 40 m to
// either side hold the next one.
constexpr double kStretch = 4.0;  // m
constexpr int kStretches = 20;    // ten on either side
constexpr double kAcross = 2.0;   // m, to either side across the ship

// Places that are turned by more than this against the map are dropped: roll, pitch, yaw, rad. A moored ship
// heels by 3 deg before alarms go, trims by 1 deg, and lies along the quay to within 3 deg; the map's own
// attitude may be as far to the other side.
const Eigen::Vector3d kMostTurned{radians(6.0), radians(2.0), radians(6.0)};

bool could_lie(const Pose& T_H_W) {
  const Eigen::Vector3d rpy = rpy_from_rotation(T_H_W.linear().transpose());
  return (rpy.array().abs() <= kMostTurned.array()).all();
}

struct Shift {
  int x, y, z;  // by how many cells the hull is moved
  int score;
};

/// First and last whole cell within [low, high], m. An interval without one gets the cell nearest its middle.
std::pair<int, int> cells_within(float low, float high) {
  const auto middle = static_cast<int>(std::lround((low + high) / 2.0F / OccupancyGrid::kCell));
  return {std::min(middle, static_cast<int>(std::ceil(low / OccupancyGrid::kCell))),
          std::max(middle, static_cast<int>(std::floor(high / OccupancyGrid::kCell)))};
}

/// All shifts within `reach`; a shift's score is the sum of the grid's values under the moved cells.
std::vector<Shift> correlate(const OccupancyGrid& grid, const std::vector<OccupancyGrid::Index>& cells,
                             const Box& reach) {
  const auto [x0, x1] = cells_within(reach.min.x(), reach.max.x());
  const auto [y0, y1] = cells_within(reach.min.y(), reach.max.y());
  auto [z0, z1] = cells_within(reach.min.z(), reach.max.z());
  z0 = std::max(z0, -OccupancyGrid::kUp);
  z1 = std::min(z1, OccupancyGrid::kUp);
  std::vector<Shift> shifts;
  for (int x = x0; x <= x1; ++x) {
    for (int y = y0; y <= y1; ++y) {
      std::array<std::uint16_t, OccupancyGrid::kHeights> scores{};
      grid.correlate(cells, -x, -y, scores);
      for (int z = z0; z <= z1; ++z) {
        shifts.push_back({x, y, z, scores[static_cast<std::size_t>(OccupancyGrid::kUp - z)]});
      }
    }
  }
  return shifts;
}

bool near(const Shift& a, const Shift& b) {
  return std::abs(a.x - b.x) < kApart && std::abs(a.y - b.y) < kApart && std::abs(a.z - b.z) < kApart;
}

}  // namespace

std::vector<Eigen::Vector3d> HullSearch::best_shifts(std::span<const Point> few_W, const Box& reach,
                                                     const Eigen::Matrix3d& R_W_H, std::size_t most) const {
  std::vector<OccupancyGrid::Index> cells;
  cells.reserve(few_W.size());
  const Pose T_H_W = shifted(Eigen::Vector3d::Zero(), R_W_H);
  for (const Point& p_W : few_W) {
    cells.push_back(map_->occupancy().cell_of((T_H_W * p_W.cast<double>()).cast<float>()));
  }
  std::vector<Shift> shifts = correlate(map_->occupancy(), cells, reach);
  std::vector<Eigen::Vector3d> best;
  while (best.size() < most && !shifts.empty()) {
    const Shift top = *std::max_element(shifts.begin(), shifts.end(),
                                        [](const Shift& a, const Shift& b) { return a.score < b.score; });
    best.emplace_back(kCell * top.x, kCell * top.y, kCell * top.z);
    std::erase_if(shifts, [&](const Shift& shift) { return near(shift, top); });
  }
  return best;
}

Pose HullSearch::shifted(const Eigen::Vector3d& shift_H, const Eigen::Matrix3d& R_W_H) const {
  Pose T_W_H = Pose::Identity();
  T_W_H.linear() = R_W_H;
  T_W_H.translation() = reference_H_ + R_W_H * (shift_H - reference_H_);
  return T_W_H.inverse();
}

void HullSearch::begin(std::span<const Point> few_W, const Box& reach, const Eigen::Matrix3d& R_W_H) {
  places_.clear();
  next_ = 0;
  starts_ = {Pose::Identity()};
  for (const Eigen::Vector3d& shift_H : best_shifts(few_W, reach, R_W_H, kMostStarts)) {
    starts_.push_back(shifted(shift_H, R_W_H));
  }
}

double HullSearch::distance(const Pose& a, const Pose& b) const {
  return (a.inverse() * reference_H_ - b.inverse() * reference_H_).norm();
}

void HullSearch::add(const Place& place) {
  if (!could_lie(place.T_H_W)) {
    return;
  }
  for (Place& known : places_) {
    if (distance(known.T_H_W, place.T_H_W) < kSamePlace) {
      return;
    }
  }
  places_.push_back(place);
}

double HullSearch::score(std::span<const Point> few_W, const Pose& T_H_W, PointToPlaneIcp& icp) const {
  const PlaneScore score = icp.score(few_W, map_->planes(), T_H_W);
  return score.points == 0 ? 0.0 : score.sum / score.points;
}

void HullSearch::score_places(std::span<const Point> few_W, PointToPlaneIcp& icp) {
  for (Place& place : places_) {
    place.score = score(few_W, place.T_H_W, icp);
  }
  std::stable_sort(places_.begin(), places_.end(),
                   [](const Place& a, const Place& b) { return a.score > b.score; });
  places_.resize(std::min(places_.size(), kMostPlaces));
}

Pose HullSearch::slide(std::span<const Point> few_W, const Pose& T_H_W, PointToPlaneIcp& icp) const {
  Pose best = T_H_W;
  double best_score = score(few_W, T_H_W, icp);
  for (const int axis : {0, 1}) {
    const Pose from = best;
    for (const double by : kSlides) {
      Pose T = from;
      T.translation()[axis] += by;
      if (const double here = score(few_W, T, icp); here > best_score) {
        best = T;
        best_score = here;
      }
    }
  }
  return best;
}

void HullSearch::advance(std::span<const Point> few_W, std::size_t starts, PointToPlaneIcp& icp) {
  const std::size_t end = std::min(starts_.size(), next_ + starts);
  for (; next_ < end; ++next_) {
    add({.T_H_W = slide(few_W, icp.approach(few_W, map_->planes(), starts_[next_]), icp)});
  }
  score_places(few_W, icp);
}

std::optional<Pose> HullSearch::challenge(std::span<const Point> few_W, const Pose& T_H_W, double margin,
                                          PointToPlaneIcp& icp) {
  const auto stretch = static_cast<int>(challenges_++ % kStretches) - kStretches / 2;
  const Pose T_W_H = T_H_W.inverse();
  const Eigen::Vector3d here_H = T_W_H.linear().transpose() * (T_W_H * reference_H_ - reference_H_);
  const Eigen::Vector3d low =
      here_H + Eigen::Vector3d(stretch * kStretch, -kAcross, -kCell * OccupancyGrid::kUp);
  const Eigen::Vector3d high =
      here_H + Eigen::Vector3d((stretch + 1) * kStretch, kAcross, kCell * OccupancyGrid::kUp);
  for (const Eigen::Vector3d& shift_H :
       best_shifts(few_W, {low.cast<float>(), high.cast<float>()}, T_W_H.linear(), 2)) {
    if ((shift_H - here_H).norm() > 2.0 * kSamePlace) {
      const Pose T = icp.approach(few_W, map_->planes(), shifted(shift_H, T_W_H.linear()));
      const bool better = score(few_W, T, icp) > margin * score(few_W, T_H_W, icp);
      return better && could_lie(T) && distance(T, T_H_W) > kSamePlace ? std::optional(T) : std::nullopt;
    }
  }
  return std::nullopt;
}

void HullSearch::settle(const Pose& from, const Pose& to, bool contradicted) {
  std::erase_if(places_, [&](const Place& place) {
    return distance(place.T_H_W, from) < kSamePlace || distance(place.T_H_W, to) < kSamePlace;
  });
  add({to, 0.0, contradicted, !contradicted});
}

}  // namespace hulltrack
