// What one LiDAR really saw in a scan, sorted by direction from its mid-scan pose.
//
// Frame L of the LiDAR at the middle of the scan, metres; cells of SphericalGrid. It answers three
// questions: which returns lie near a direction, does something hide what lies there, and does the sensor
// look there at all. What hides is what half of the returns of a cell show: a drop of rain before a deck is
// one return of several, a chute is all of them. The field of view is learned: from the lowest to the highest
// row (its lasers may be more than a cell apart) and every column in which this LiDAR has ever had a return;
// it only grows, so that a sight that went empty (the ship left, packets were lost) still counts as looked
// at. Thread rule: one owner. Cost: one pass over the returns, no allocation in steady state.
#pragma once

#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/se3.hpp"
#include "core/geometry/spherical_grid.hpp"

namespace hulltrack {

class ScanView {
 public:
  /// `returns_W`: all that the LiDAR measured in the scan; T_W_L is its pose at the middle of it.
  void rebuild(std::span<const Point> returns_W, const Pose& T_W_L);

  [[nodiscard]] const Pose& T_W_L() const { return T_W_L_; }

  /// The returns in a cell, in L.
  [[nodiscard]] std::span<const Point> returns(SphericalGrid::Cell cell) const {
    const std::size_t i = cell.index();
    return std::span(points_L_).subspan(first_[i], first_[i + 1] - first_[i]);
  }

  /// The returns of columns first .. last (first <= last < kColumns) of a row, and where each of them stands
  /// in `returns_W` of rebuild().
  struct Returns {
    std::span<const Point> points_L;
    std::span<const std::uint32_t> numbers;
  };
  [[nodiscard]] Returns returns(int row, int first, int last) const {
    const std::size_t begin = first_[SphericalGrid::Cell{row, first}.index()];
    const std::size_t count = first_[SphericalGrid::Cell{row, last}.index() + 1] - begin;
    return {std::span(points_L_).subspan(begin, count), std::span(numbers_).subspan(begin, count)};
  }

  /// A point of W in L.
  [[nodiscard]] Point seen(const Point& p_W) const { return R_L_W_ * p_W + t_L_W_; }

  /// Calls visit(return in L) for those in a cell and the eight around it.
  template <typename Visit>
  void visit_around(SphericalGrid::Cell cell, Visit&& visit) const {
    for (int dr = -1; dr <= 1; ++dr) {
      for (int dc = -1; dc <= 1; ++dc) {
        for (const Point& returned : returns(cell.moved(dr, dc))) {
          visit(returned);
        }
      }
    }
  }

  [[nodiscard]] bool looks_at(SphericalGrid::Cell cell) const {
    return cell.row >= lowest_row_ && cell.row <= highest_row_ &&
           columns_seen_[static_cast<std::size_t>(cell.column)];
  }

  /// The rows that looks_at() says yes to; none before the first return: then the lowest is above the
  /// highest.
  [[nodiscard]] int lowest_row() const { return lowest_row_; }
  [[nodiscard]] int highest_row() const { return highest_row_; }

  /// True if a point at `range` in this cell is behind most of what the scan saw: by kBehind in the cell
  /// itself, or by kFarBehind in a neighbouring one (beams are sparser than cells; a chute is nearer by
  /// metres, while a deck seen at a low angle changes its range by decimetres from cell to cell).
  [[nodiscard]] bool hidden(SphericalGrid::Cell cell, float range) const {
    return front_[cell.index()] < range - kBehind || front_around_[cell.index()] < range - kFarBehind;
  }

  static constexpr float kBehind = 0.4F;     // m (ICD 3)
  static constexpr float kFarBehind = 2.0F;  // m

 private:
  void sort_by_cell();
  void note_field_of_view(SphericalGrid::Cell cell);
  void find_fronts();
  void spread_fronts();

  Pose T_W_L_ = Pose::Identity();
  Eigen::Matrix3f R_L_W_ = Eigen::Matrix3f::Identity();
  Point t_L_W_ = Point::Zero();
  std::vector<Point> unsorted_L_;
  std::vector<std::uint32_t> cell_of_;
  std::vector<Point> points_L_;         // by cell
  std::vector<std::uint32_t> numbers_;  // likewise: of the returns given
  std::vector<std::uint32_t> first_;    // kCells + 1 offsets into points_L_
  std::vector<float> front_;            // per cell: median range of its returns, m; infinity without a return
  std::vector<float> front_beside_;     // the least of a cell and its two neighbours in the row
  std::vector<float> front_around_;     // the least of a cell and its eight neighbours
  std::vector<float> ranges2_;          // of one cell, squared
  int lowest_row_ = SphericalGrid::kRows;
  int highest_row_ = -1;
  std::bitset<SphericalGrid::kColumns> columns_seen_;
};

}  // namespace hulltrack
