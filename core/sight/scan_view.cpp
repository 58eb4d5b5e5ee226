#include "core/sight/scan_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/sighting.hpp"

namespace hulltrack {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

}  // namespace

void ScanView::rebuild(std::span<const Point> returns_W, const Pose& T_W_L) {
  const Pose T_L_W = T_W_L.inverse();
  T_W_L_ = T_W_L;
  R_L_W_ = T_L_W.linear().cast<float>();
  t_L_W_ = T_L_W.translation().cast<float>();
  unsorted_L_.resize(returns_W.size());
  cell_of_.resize(returns_W.size());
  sight(returns_W, T_L_W, [this](std::size_t at, const Sightings& seen, std::size_t i) {
    unsorted_L_[at] = seen.point(i);
    cell_of_[at] = seen.cell[i];
  });
  sort_by_cell();
  find_fronts();
  spread_fronts();
}

void ScanView::sort_by_cell() {
  first_.assign(SphericalGrid::kCells + 1, 0);
  for (const std::uint32_t cell : cell_of_) {
    ++first_[cell];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) {
    first_[i] += first_[i - 1];
  }
  points_L_.resize(unsorted_L_.size());
  numbers_.resize(unsorted_L_.size());
  for (std::size_t i = unsorted_L_.size(); i-- > 0;) {  // offsets fall from the cells' ends to their begins
    const std::uint32_t at = --first_[cell_of_[i]];
    points_L_[at] = unsorted_L_[i];
    numbers_[at] = static_cast<std::uint32_t>(i);
  }
}

void ScanView::note_field_of_view(SphericalGrid::Cell cell) {
  lowest_row_ = std::min(lowest_row_, cell.row);
  highest_row_ = std::max(highest_row_, cell.row);
  columns_seen_.set(static_cast<std::size_t>(cell.column));
}

void ScanView::find_fronts() {
  front_.assign(SphericalGrid::kCells, kNothing);
  for (int row = 0; row < SphericalGrid::kRows; ++row) {
    for (int column = 0; column < SphericalGrid::kColumns; ++column) {
      const SphericalGrid::Cell cell{row, column};
      const std::span<const Point> here = returns(cell);
      if (here.empty()) {
        continue;
      }
      note_field_of_view(cell);
      ranges2_.clear();
      for (const Point& p : here) {
        ranges2_.push_back(p.squaredNorm());
      }
      const auto middle = ranges2_.begin() + static_cast<std::ptrdiff_t>(ranges2_.size() / 2);
      std::nth_element(ranges2_.begin(), middle, ranges2_.end());
      front_[cell.index()] = std::sqrt(*middle);
    }
  }
}

// The least of three neighbours along each row, which closes upon itself, then of three rows.
void ScanView::spread_fronts() {
  constexpr std::size_t kWidth = SphericalGrid::kColumns;
  front_beside_.resize(SphericalGrid::kCells);
  front_around_.resize(SphericalGrid::kCells);
  for (std::size_t begin = 0; begin < SphericalGrid::kCells; begin += kWidth) {
    const float* row = &front_[begin];
    float* beside = &front_beside_[begin];
    beside[0] = std::min({row[kWidth - 1], row[0], row[1]});
    for (std::size_t i = 1; i + 1 < kWidth; ++i) {
      beside[i] = std::min(std::min(row[i - 1], row[i]), row[i + 1]);
    }
    beside[kWidth - 1] = std::min({row[kWidth - 2], row[kWidth - 1], row[0]});
  }
  for (std::size_t begin = 0; begin < SphericalGrid::kCells; begin += kWidth) {
    const float* here = &front_beside_[begin];
    const float* below = begin == 0 ? here : here - kWidth;
    const float* above = begin + kWidth == SphericalGrid::kCells ? here : here + kWidth;
    float* around = &front_around_[begin];
    for (std::size_t i = 0; i < kWidth; ++i) {
      around[i] = std::min(std::min(below[i], here[i]), above[i]);
    }
  }
}

}  // namespace hulltrack
