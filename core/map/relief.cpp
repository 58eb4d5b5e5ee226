#include "core/map/relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/map/covers_place.hpp"
#include "core/map/horizons.hpp"

namespace hulltrack {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();
constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr float kNoRim = std::numeric_limits<float>::quiet_NaN();

// smooth_rims() takes every third cell along both axes, to save time: 9 x 9 cells around each one at most.
constexpr int kStride = 3;

std::vector<float> highest_points(const LevelCells& cells, std::span<const Point> cloud_H) {
  std::vector<float> tops(cells.size(), kNothing);
  for (const Point& p : cloud_H) {
    float& top = tops[cells.place_of(cells.cell_of(p))];
    top = std::max(top, p.z());
  }
  return tops;
}

}  // namespace

Relief::Relief(std::span<const Point> cloud_H) : cells_(cloud_H) {
  const std::vector<float> top = highest_points(cells_, cloud_H);
  horizon_ = find_horizons(cells_, top);
  find_holds(top);
  find_insides();
  smooth_rims();
  number_holds();
  covers_from_ = find_covers_place(cells_, rims_of_insides(),
                                   [this](Cell low, Cell high) { return any_hold(low, high); });
  tall_ = find_tall_columns(cells_, top, covers_from_);
}

bool Relief::in_hold(const Point& p) const {
  return cells_.at(horizon_, cells_.cell_of(p), kNothing) >= p.z() + kDepth;
}

void Relief::find_holds(const std::vector<float>& top) {
  rim_height_.assign(cells_.size(), kNoRim);
  std::vector<Cell> grown;
  cells_.for_each_cell([&](Cell c, std::size_t place) {
    if (top[place] != kNothing && horizon_[place] >= top[place] + kDepth) {
      rim_height_[place] = horizon_[place];
      grown.push_back(c);
    }
  });
  // Empty cells that touch a hold and have a horizon become hold: no survey saw the shadow under a coaming.
  while (!grown.empty()) {
    const Cell from = grown.back();
    grown.pop_back();
    for (const auto& [dc, dr] : kDirections) {
      const Cell c{from.column + dc, from.row + dr};
      const std::size_t place = cells_.place_of(c);
      if (place != LevelCells::kNoPlace && top[place] == kNothing && std::isnan(rim_height_[place]) &&
          horizon_[place] != kNothing) {
        rim_height_[place] = horizon_[place];
        grown.push_back(c);
      }
    }
  }
}

void Relief::find_insides() {
  inside_hold_.assign(rim_height_.size(), 0);
  tile_has_hold_.assign(cells_.corners().size(), 0);
  cells_.for_each_cell([&](Cell c, std::size_t place) {
    if (!std::isnan(rim_height_[place]) &&
        std::all_of(kDirections.begin(), kDirections.end(), [&](const auto& d) {
          return !std::isnan(cells_.at(rim_height_, {c.column + d.first, c.row + d.second}, kNoRim));
        })) {
      inside_hold_[place] = 1;
      tile_has_hold_[place / LevelCells::kTileCells] = 1;
    }
  });
}

/// Per cell: height of the rim if it is inside a hold, m; NaN elsewhere.
std::vector<float> Relief::rims_of_insides() const {
  std::vector<float> rims(rim_height_.size(), kNoRim);
  for (std::size_t place = 0; place < rims.size(); ++place) {
    rims[place] = inside_hold_[place] != 0 ? rim_height_[place] : kNoRim;
  }
  return rims;
}

/// Replaces the rim of each cell inside a hold by the upper quartile of the rims within kCoversReach. A gap
/// in a coaming, or a corner that the survey missed, lowers the rim of all cells in line with it, and nothing
/// raises a rim. Rims farther away are left out, since a coaming's height follows trim and sheer.
void Relief::smooth_rims() {
  // A multiple of kStride, so that the steps from -reach to reach meet the cell itself.
  const int reach = LevelCells::cells(kCoversReach) / kStride * kStride;
  const std::vector<float> rims = rims_of_insides();
  LevelCells::Window<float> window(kNoRim);
  std::vector<float> around;
  for (std::size_t tile = 0; tile < cells_.corners().size(); ++tile) {
    if (tile_has_hold_[tile] == 0) {
      continue;
    }
    cells_.copy_around(rims, tile, 1, window);
    for (std::size_t i = 0; i < LevelCells::kTileCells; ++i) {
      const std::size_t place = tile * LevelCells::kTileCells + i;
      if (inside_hold_[place] == 0) {
        continue;
      }
      const Cell c{cells_.corners()[tile].column + static_cast<int>(i) % LevelCells::kTile,
                   cells_.corners()[tile].row + static_cast<int>(i) / LevelCells::kTile};
      around.clear();
      for (int dr = -reach; dr <= reach; dr += kStride) {
        for (int dc = -reach; dc <= reach; dc += kStride) {
          if (const float rim = window.at({c.column + dc, c.row + dr}); !std::isnan(rim)) {
            around.push_back(rim);
          }
        }
      }
      const auto quartile = around.begin() + static_cast<std::ptrdiff_t>(3 * around.size() / 4);
      std::nth_element(around.begin(), quartile, around.end());
      rim_height_[place] = *quartile;
    }
  }
}

/// Connected cells inside holds are one hold.
void Relief::number_holds() {
  hold_.assign(cells_.size(), kNoHold);
  std::uint32_t holds = 0;
  std::vector<Cell> grown;
  cells_.for_each_cell([&](Cell first, std::size_t) {
    const auto join = [&](Cell c) {
      const std::size_t place = cells_.place_of(c);
      if (place != LevelCells::kNoPlace && inside_hold_[place] != 0 && hold_[place] == kNoHold) {
        hold_[place] = holds;
        grown.push_back(c);
      }
    };
    join(first);
    const bool begun = !grown.empty();
    while (!grown.empty()) {
      const Cell from = grown.back();
      grown.pop_back();
      for (const auto& [dc, dr] : kDirections) {
        join({from.column + dc, from.row + dr});
      }
    }
    holds += begun ? 1 : 0;
  });
}

bool Relief::under_covers_place(const Point& p) const {
  return in_covers_place(p) || cells_.at(tall_, cells_.cell_of(p), std::uint8_t{0}) != 0;
}

bool Relief::in_covers_place(const Point& p) const {
  return p.z() > cells_.at(covers_from_, cells_.cell_of(p), kNowhere);
}

std::uint32_t Relief::hold_near(const Point& p, float reach) const {
  const std::optional<Point> over = over_hold_near(p, reach);
  return over ? cells_.at(hold_, cells_.cell_of(*over), kNoHold) : kNoHold;
}

/// Whether one of the tiles that hold the cells from `low` to `high` has a cell inside a hold.
bool Relief::any_hold(Cell low, Cell high) const {
  for (int row = low.row >> LevelCells::kTileBits; row <= high.row >> LevelCells::kTileBits; ++row) {
    for (int column = low.column >> LevelCells::kTileBits; column <= high.column >> LevelCells::kTileBits;
         ++column) {
      const std::uint32_t tile = cells_.tile(column, row);
      if (tile != BlockIndex::kNone && tile_has_hold_[tile] != 0) {
        return true;
      }
    }
  }
  return false;
}

std::optional<Point> Relief::over_hold_near(const Point& p, float reach) const {
  const Cell here = cells_.cell_of(p);
  const int far = LevelCells::cells(reach);
  std::optional<Point> best;
  if (!any_hold({here.column - far, here.row - far}, {here.column + far, here.row + far})) {
    return best;
  }
  float best2 = reach * reach;
  for (int dr = -far; dr <= far; ++dr) {
    for (int dc = -far; dc <= far; ++dc) {
      const Cell c{here.column + dc, here.row + dr};
      if (const std::size_t place = cells_.place_of(c);
          place == LevelCells::kNoPlace || inside_hold_[place] == 0) {
        continue;
      }
      const Point q = cells_.middle_of(c, p.z());
      const float distance2 = (q - p).squaredNorm();
      if (distance2 < best2) {
        best2 = distance2;
        best = q;
      }
    }
  }
  return best;
}

std::size_t Relief::memory() const {
  const std::size_t floats = horizon_.capacity() + covers_from_.capacity() + rim_height_.capacity();
  return floats * sizeof(float) + hold_.capacity() * sizeof(std::uint32_t) + inside_hold_.capacity() +
         tall_.capacity() + tile_has_hold_.capacity() + cells_.memory();
}

}  // namespace hulltrack
