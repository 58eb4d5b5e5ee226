#include "core/sight/nearest_returns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace hulltrack {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kPerRadian = 180.0F / std::numbers::pi_v<float>;  // cells of SphericalGrid (1 deg)
// Directions are known to 1e-5 rad, distances in L to 1e-5 m.
constexpr float kRounding = 1e-4F;  // rad
// Squares of cells that are searched: this many cells to each side of the point's own. Beyond them a tree is
// faster.
constexpr std::array<int, 6> kAround = {0, 1, 2, 4, 8, 16};  // cells
// This many squares are searched in every LiDAR's view before the larger ones: a sparse LiDAR's lasers are 2
// deg apart, and another LiDAR may have a return nearer.
constexpr std::size_t kFirstLooks = 3;

/// The nearest candidate for hull so far.
struct Nearest {
  float squared = kInfinity;  // distance in L, m^2
  std::size_t lidar = 0;
  std::uint32_t number = 0;  // index into the LiDAR's returns
};

/// How many rows and columns to either side of a point hold all that lies within a distance of it, in cells;
/// infinite if the sensor itself or a pole lies within.
struct Cap {
  float rows = std::numeric_limits<float>::infinity();
  float columns = std::numeric_limits<float>::infinity();
};
Cap cap_around(const Point& p_L, float squared) {
  const float range = p_L.norm();
  const float sine = std::sqrt(squared) / range;
  if (!(sine < 1.0F)) {
    return {};
  }
  const float angle = std::asin(sine) + kRounding;
  // A circle of directions spans more columns than rows, the more the nearer it is to a pole.
  const float sine_across = std::sin(angle) * range / p_L.head<2>().norm();
  if (!(sine_across < 1.0F)) {
    return {};
  }
  return {angle * kPerRadian, (std::asin(sine_across) + kRounding) * kPerRadian};
}

/// Searches the squares around one point in one LiDAR's view.
class Search {
 public:
  Search(const ScanView& view, const std::vector<ReturnOf>& of, std::size_t lidar, const Point& p_W)
      : view_(view), of_(of), lidar_(lidar), p_L_(view.seen(p_W)), centre_(SphericalGrid::cell(p_L_)) {}

  /// Searches the squares first .. last - 1 of kAround for candidates nearer than `nearest`. True as soon as
  /// no return outside a searched square can be nearer.
  [[nodiscard]] bool look(std::size_t first, std::size_t last, Nearest& nearest) const {
    for (std::size_t i = first; i < last; ++i) {
      look_around(kAround[i], nearest);
      if (is_all_within(kAround[i], nearest)) {
        return true;
      }
    }
    return false;
  }

 private:
  /// Takes the worst case, a point on the edge of its cell.
  [[nodiscard]] bool is_all_within(int around, const Nearest& nearest) const {
    if (nearest.squared == kInfinity) {
      return false;
    }
    const Cap cap = cap_around(p_L_, nearest.squared);
    return cap.rows <= static_cast<float>(around) && cap.columns <= static_cast<float>(around);
  }

  /// Columns wrap around, rows end at the poles.
  void look_around(int around, Nearest& nearest) const {
    constexpr int kColumns = SphericalGrid::kColumns;
    const int first = centre_.column - around;
    const int last = centre_.column + around;
    const int lowest = std::max(centre_.row - around, 0);
    const int highest = std::min(centre_.row + around, SphericalGrid::kRows - 1);
    for (int row = lowest; row <= highest; ++row) {
      look_at(row, std::max(first, 0), std::min(last, kColumns - 1), nearest);
      if (first < 0) {
        look_at(row, first + kColumns, kColumns - 1, nearest);
      }
      if (last >= kColumns) {
        look_at(row, 0, last - kColumns, nearest);
      }
    }
  }

  void look_at(int row, int first, int last, Nearest& nearest) const {
    const ScanView::Returns returns = view_.returns(row, first, last);
    for (std::size_t i = 0; i < returns.points_L.size(); ++i) {
      const float squared = (returns.points_L[i] - p_L_).squaredNorm();
      if (squared < nearest.squared && of_[returns.numbers[i]] == ReturnOf::hull) {
        nearest = {squared, lidar_, returns.numbers[i]};
      }
    }
  }

  const ScanView& view_;
  const std::vector<ReturnOf>& of_;
  std::size_t lidar_;
  Point p_L_;
  SphericalGrid::Cell centre_;
};

/// The candidate nearest to p_W in all views; nothing if the squares do not decide it and the tree has to.
std::optional<Nearest> find_nearest(const Point& p_W, std::span<const ScanView> views,
                                    const FilteredScan& scan) {
  Nearest nearest;
  const auto search = [&](std::size_t lidar) { return Search(views[lidar], scan.of[lidar], lidar, p_W); };
  bool sure = true;
  for (std::size_t i = 0; i < views.size(); ++i) {
    sure = search(i).look(0, kFirstLooks, nearest) && sure;
  }
  for (std::size_t i = 0; i < views.size() && !sure; ++i) {
    if (!search(i).look(kFirstLooks - 1, kAround.size(), nearest)) {
      return std::nullopt;
    }
  }
  return nearest;
}

/// The same float operations as in the tree, so that both ways give the same bits.
double distance_between(const Point& a, const Point& b) {
  const Point d = a - b;
  return std::sqrt(static_cast<double>((d.x() * d.x() + d.y() * d.y()) + d.z() * d.z()));
}

}  // namespace

void NearestReturns::run(std::span<const Point> points_W, std::span<const ScanView> views,
                         const FilteredScan& scan, std::vector<double>& distances) {
  distances.clear();
  if (scan.hull_W.empty()) {
    return;
  }
  unknown_.clear();
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const std::optional<Nearest> nearest = find_nearest(points_W[i], views, scan);
    if (nearest) {
      distances.push_back(distance_between(scan.returns_W[nearest->lidar][nearest->number], points_W[i]));
    } else {
      distances.push_back(0.0);
      unknown_.push_back(i);
    }
  }
  if (!unknown_.empty()) {
    ask_tree(points_W, scan.hull_W, distances);
  }
}

void NearestReturns::ask_tree(std::span<const Point> points_W, const Cloud& hull_W,
                              std::vector<double>& distances) {
  queries_W_.clear();
  for (const std::size_t i : unknown_) {
    queries_W_.push_back(points_W[i]);
  }
  answers_.resize(queries_W_.size());
  KdTree(hull_W, TreeUse::one_batch).nearest(queries_W_, kInfinity, answers_);
  for (std::size_t u = 0; u < unknown_.size(); ++u) {
    distances[unknown_[u]] = std::sqrt(static_cast<double>(answers_[u].squared_distance));
  }
}

}  // namespace hulltrack
