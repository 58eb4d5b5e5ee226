#include "core/tracking/scan_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/sighting.hpp"

namespace hulltrack {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

}  // namespace

void ScanView::rebuild(std::span<const Point> returns_W, const Pose& T_W_L) {
  T_W_L_ = T_W_L;
  unsorted_L_.resize(returns_W.size());
  cell_of_.resize(returns_W.size());
  sight(returns_W, T_W_L.inverse(), [this](std::size_t at, const Sightings& seen, std::size_t i) {
    unsorted_L_[at] = seen.point(i);
    cell_of_[at] = seen.cell[i];
  });
  sort_by_cell();
  find_fronts();
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
  for (std::size_t i = unsorted_L_.size(); i-- > 0;) {  // filled from the back: offsets end where cells begin
    points_L_[--first_[cell_of_[i]]] = unsorted_L_[i];
  }
}

void ScanView::note_field_of_view(SphericalGrid::Cell cell) {
  lowest_row_ = std::min(lowest_row_, cell.row);
  highest_row_ = std::max(highest_row_, cell.row);
  columns_seen_.set(static_cast<std::size_t>(cell.column));
}

void ScanView::find_fronts() {
  front_.assign(SphericalGrid::kCells, kNothing);
  front_around_.assign(SphericalGrid::kCells, kNothing);
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
      const float front = std::sqrt(*middle);
      front_[cell.index()] = front;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) {
          float& around = front_around_[cell.moved(dr, dc).index()];
          around = std::min(around, front);
        }
      }
    }
  }
}

}  // namespace hulltrack
