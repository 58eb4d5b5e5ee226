// What one LiDAR really saw in a scan: its returns, sorted by direction into SphericalGrid's cells of 1 deg.
//
//   returns()   which returns lie in a direction?
//   hidden()    does something hide a point there? A cell's front is the median range of its returns. A chute
//               takes all returns of a cell and hides what lies behind it; a raindrop before a deck takes one
//               of several and hides nothing.
//   looks_at()  does the sensor look there at all? Its field of view is learned and only grows: all rows from
//               the lowest to the highest with a return so far (lasers may be more than a cell apart), and
//               every column with a return so far. So a direction that has gone empty (the ship left, packets
//               were lost) still counts as looked at.
// Frame L of the LiDAR at the middle of the scan, metres. Thread rule: one owner. Cost: one pass over the
// returns, no allocation in steady state.
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

  /// The returns in columns first .. last (first <= last < kColumns) of a row, and the index of each of them
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

  /// Calls visit(return in L) for the returns in a cell and in the eight around it.
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

  /// The lowest and the highest row with a return so far; lowest > highest before the first return.
  [[nodiscard]] int lowest_row() const { return lowest_row_; }
  [[nodiscard]] int highest_row() const { return highest_row_; }

  /// True if a point at `range` (m) in this cell lies behind what was seen: by more than kBehind behind the
  /// cell's own front, or by more than kFarBehind behind the front of one of the eight cells around. Those
  /// count because beams are sparser than cells. Their limit is wider because a deck seen at a low angle
  /// changes its range by decimetres from cell to cell; a chute is nearer by metres.
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
  std::vector<std::uint32_t> numbers_;  // by cell: index in `returns_W`
  std::vector<std::uint32_t> first_;    // kCells + 1 offsets into points_L_
  std::vector<float> front_;            // per cell: median range of its returns, m; infinity without a return
  std::vector<float> front_beside_;     // least front of a cell and its two neighbours in the row
  std::vector<float> front_around_;     // least front of a cell and its eight neighbours
  std::vector<float> ranges2_;          // of one cell's returns, squared
  int lowest_row_ = SphericalGrid::kRows;
  int highest_row_ = -1;
  std::bitset<SphericalGrid::kColumns> columns_seen_;
};

}  // namespace hulltrack
