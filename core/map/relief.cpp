#include "core/map/relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/box.hpp"

namespace hulltrack {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr float kNoRim = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<std::pair<int, int>, 8> kDirections{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
// Above a rim by less than this is the rim itself: sheer along a hatch, rest bars, noise.
constexpr float kOnRim = 0.15F;  // m

// What is around is asked of every third cell along both axes: 64 of them at most.
constexpr int kStride = 3;

int cells(float metres) { return static_cast<int>(std::lround(metres / Relief::kCell)); }

}  // namespace

Relief::Relief(std::span<const Point> cloud_H) {
  const Box box = bounding_box(cloud_H);
  corner_ = box.min;
  columns_ = static_cast<int>((box.max.x() - box.min.x()) / kCell) + 1;
  rows_ = static_cast<int>((box.max.y() - box.min.y()) / kCell) + 1;
  top_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNothing);
  for (const Point& p : cloud_H) {
    float& top = top_[index(cell_of(p))];
    top = std::max(top, p.z());
  }
  find_horizons();
  find_pits();
  find_insides();
  smooth_rims();
  number_pits();
  raise_covers_place();
  find_tall_columns();
}

Relief::Cell Relief::cell_of(const Point& p) const {
  return {static_cast<int>(std::floor((p.x() - corner_.x()) / kCell)),
          static_cast<int>(std::floor((p.y() - corner_.y()) / kCell))};
}

/// The least, over all directions, of the highest structure within kReach.
float Relief::lowest_horizon(Cell from) const {
  float lowest = kNowhere;
  for (const auto& [dc, dr] : kDirections) {
    const float stride = dc != 0 && dr != 0 ? std::sqrt(2.0F) * kCell : kCell;
    const int steps = static_cast<int>(kReach / stride);
    float highest = kNothing;
    for (int i = 1; i <= steps; ++i) {
      const Cell c{from.column + i * dc, from.row + i * dr};
      if (!inside(c)) {
        break;
      }
      highest = std::max(highest, top_[index(c)]);
    }
    lowest = std::min(lowest, highest);
  }
  return lowest;
}

bool Relief::in_pit(const Point& p) const {
  const Cell c = cell_of(p);
  return inside(c) && horizon_[index(c)] >= p.z() + kDepth;
}

void Relief::find_horizons() {
  horizon_.reserve(top_.size());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      horizon_.push_back(lowest_horizon({column, row}));
    }
  }
}

void Relief::find_pits() {
  rim_.assign(top_.size(), kNoRim);
  std::vector<Cell> grown;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Cell c{column, row};
      const float top = top_[index(c)];
      if (const float horizon = horizon_[index(c)]; top != kNothing && horizon >= top + kDepth) {
        rim_[index(c)] = horizon;
        grown.push_back(c);
      }
    }
  }
  // What no survey saw beside a pit is pit: the shadow under a coaming.
  while (!grown.empty()) {
    const Cell from = grown.back();
    grown.pop_back();
    for (const auto& [dc, dr] : kDirections) {
      const Cell c{from.column + dc, from.row + dr};
      if (inside(c) && top_[index(c)] == kNothing && std::isnan(rim_[index(c)])) {
        if (const float horizon = horizon_[index(c)]; horizon != kNothing) {
          rim_[index(c)] = horizon;
          grown.push_back(c);
        }
      }
    }
  }
}

void Relief::find_insides() {
  const auto is_pit = [this](Cell c) { return inside(c) && !std::isnan(rim_[index(c)]); };
  inside_pit_.reserve(rim_.size());
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      inside_pit_.push_back(is_pit({column, row}) &&
                            std::all_of(kDirections.begin(), kDirections.end(), [&](const auto& d) {
                              return is_pit({column + d.first, row + d.second});
                            }));
    }
  }
}

/// A gap in a coaming, or a corner that the survey missed, lowers the rim of all that is in line with it, and
/// nothing raises one: the upper quartile of what is around is the coaming's, which follows trim and sheer.
void Relief::smooth_rims() {
  const int reach = cells(kCoversReach);
  std::vector<float> smooth = rim_;
  std::vector<float> around;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      if (!inside_pit_[index({column, row})]) {
        continue;
      }
      around.clear();
      for (int r = std::max(0, row - reach); r <= std::min(rows_ - 1, row + reach); r += kStride) {
        for (int c = std::max(0, column - reach); c <= std::min(columns_ - 1, column + reach); c += kStride) {
          if (inside_pit_[index({c, r})]) {
            around.push_back(rim_[index({c, r})]);
          }
        }
      }
      const auto quartile = around.begin() + static_cast<std::ptrdiff_t>(3 * around.size() / 4);
      std::nth_element(around.begin(), quartile, around.end());
      smooth[index({column, row})] = *quartile;
    }
  }
  rim_ = std::move(smooth);
}

/// Connected insides are one pit.
void Relief::number_pits() {
  pit_.assign(top_.size(), kNoPit);
  std::uint32_t pits = 0;
  std::vector<Cell> grown;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const auto join = [&](Cell c) {
        if (inside(c) && inside_pit_[index(c)] && pit_[index(c)] == kNoPit) {
          pit_[index(c)] = pits;
          grown.push_back(c);
        }
      };
      join({column, row});
      const bool begun = !grown.empty();
      while (!grown.empty()) {
        const Cell from = grown.back();
        grown.pop_back();
        for (const auto& [dc, dr] : kDirections) {
          join({from.column + dc, from.row + dr});
        }
      }
      pits += begun ? 1 : 0;
    }
  }
}

void Relief::raise_covers_place() {
  covers_from_.assign(top_.size(), kNowhere);
  const int reach = cells(kCoversReach) + 1;  // from a cell inside of the rim; a gap without one is no hold
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const float rim = rim_[index({column, row})];
      if (!inside_pit_[index({column, row})]) {
        continue;
      }
      for (int r = std::max(0, row - reach); r <= std::min(rows_ - 1, row + reach); ++r) {
        for (int c = std::max(0, column - reach); c <= std::min(columns_ - 1, column + reach); ++c) {
          float& from = covers_from_[index({c, r})];
          from = std::min(from, rim + kOnRim);
        }
      }
    }
  }
}

/// With the cells around, since the sides of what stands there may lean by as much.
void Relief::find_tall_columns() {
  tall_.assign(top_.size(), false);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Cell c{column, row};
      if (top_[index(c)] <= covers_from_[index(c)]) {
        continue;
      }
      tall_[index(c)] = true;
      for (const auto& [dc, dr] : kDirections) {
        const Cell beside{column + dc, row + dr};
        if (inside(beside) && covers_from_[index(beside)] != kNowhere) {
          tall_[index(beside)] = true;
        }
      }
    }
  }
}

bool Relief::under_covers_place(const Point& p) const {
  const Cell c = cell_of(p);
  return in_covers_place(p) || (inside(c) && tall_[index(c)]);
}

bool Relief::in_covers_place(const Point& p) const {
  const Cell c = cell_of(p);
  return inside(c) && p.z() > covers_from_[index(c)];
}

std::uint32_t Relief::pit_near(const Point& p, float reach) const {
  const std::optional<Point> over = over_pit_near(p, reach);
  return over ? pit_[index(cell_of(*over))] : kNoPit;
}

std::optional<Point> Relief::over_pit_near(const Point& p, float reach) const {
  const Cell at = cell_of(p);
  const int far = cells(reach);
  std::optional<Point> best;
  float best2 = reach * reach;
  for (int dr = -far; dr <= far; ++dr) {
    for (int dc = -far; dc <= far; ++dc) {
      const Cell c{at.column + dc, at.row + dr};
      if (!inside(c) || !inside_pit_[index(c)]) {
        continue;
      }
      const Point q(corner_.x() + (static_cast<float>(c.column) + 0.5F) * kCell,
                    corner_.y() + (static_cast<float>(c.row) + 0.5F) * kCell, p.z());
      const float distance2 = (q - p).squaredNorm();
      if (distance2 < best2) {
        best2 = distance2;
        best = q;
      }
    }
  }
  return best;
}

}  // namespace hulltrack
