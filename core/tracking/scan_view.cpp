#include "core/tracking/scan_view.hpp"

#include <limits>

namespace hulltrack {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

}  // namespace

void ScanView::rebuild(std::span<const Return> returns, std::uint16_t lidar, const Pose& T_W_L) {
  T_W_L_ = T_W_L;
  const Eigen::Matrix3f R = T_W_L.linear().transpose().cast<float>();
  const Point t = T_W_L.inverse().translation().cast<float>();
  unsorted_L_.clear();
  cell_of_.clear();
  for (const Return& r : returns) {
    if (r.lidar != lidar) {
      continue;
    }
    const Point p_L = R * r.p_W + t;
    const SphericalGrid::Cell cell = SphericalGrid::cell(p_L);
    unsorted_L_.push_back(p_L);
    cell_of_.push_back(static_cast<std::uint32_t>(cell.index()));
    lowest_row_ = std::min(lowest_row_, cell.row);
    highest_row_ = std::max(highest_row_, cell.row);
    columns_seen_.set(static_cast<std::size_t>(cell.column));
  }
  sort_by_cell();
  find_nearest();
}

void ScanView::sort_by_cell() {
  first_.assign(SphericalGrid::kCells + 1, 0);
  for (const std::uint32_t cell : cell_of_) {
    ++first_[cell + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) {
    first_[i] += first_[i - 1];
  }
  points_L_.resize(unsorted_L_.size());
  for (std::size_t i = unsorted_L_.size(); i-- > 0;) {  // filled from the back: first_ ends where it began
    points_L_[--first_[cell_of_[i] + 1]] = unsorted_L_[i];
  }
  // Each first_[cell + 1] now holds where `cell` begins: shift by one.
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
    first_[i] = first_[i + 1];
  }
  first_.back() = static_cast<std::uint32_t>(points_L_.size());
}

void ScanView::find_nearest() {
  nearest_.assign(SphericalGrid::kCells, kNothing);
  nearest_around_.assign(SphericalGrid::kCells, kNothing);
  for (int row = 0; row < SphericalGrid::kRows; ++row) {
    for (int column = 0; column < SphericalGrid::kColumns; ++column) {
      const SphericalGrid::Cell cell{row, column};
      float nearest2 = kNothing;
      for (const Point& p : returns(cell)) {
        nearest2 = std::min(nearest2, p.squaredNorm());
      }
      if (nearest2 == kNothing) {
        continue;
      }
      const float nearest = std::sqrt(nearest2);
      nearest_[cell.index()] = nearest;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) {
          float& around = nearest_around_[cell.moved(dr, dc).index()];
          around = std::min(around, nearest);
        }
      }
    }
  }
}

}  // namespace hulltrack
