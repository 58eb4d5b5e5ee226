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
// What stands higher than a rim by less than this still belongs to the rim: sheer, rest bars and noise.
constexpr float kOnRim = 0.15F;  // m

// smooth_rims() takes every third cell along both axes, to save time: 9 x 9 cells around each one at most.
constexpr int kStride = 3;

// kReach in tiles: the horizon of a cell depends on this many tiles in each direction, beyond the cell's own.
constexpr int kFarTiles = 5;
static_assert(Relief::kReach / Relief::kCell / Relief::kTile == float{kFarTiles});

int cells(float metres) { return static_cast<int>(std::lround(metres / Relief::kCell)); }

}  // namespace

template <typename T>
struct Relief::Window {
  explicit Window(T value_of_nothing) : nothing(value_of_nothing) {}

  [[nodiscard]] bool holds(Cell c) const {
    return c.column >= first.column && c.column < first.column + columns && c.row >= first.row &&
           c.row < first.row + rows;
  }
  [[nodiscard]] const T& of(Cell c) const {
    return values[static_cast<std::size_t>((c.row - first.row) * columns + c.column - first.column)];
  }
  [[nodiscard]] T at(Cell c) const { return holds(c) ? of(c) : nothing; }

  T nothing;
  Cell first{};
  int columns = 0;
  int rows = 0;
  std::vector<T> values;
};

Relief::Relief(std::span<const Point> cloud_H) {
  const Box box = bounding_box(cloud_H);
  corner_ = box.min;
  const Cell last = cell_of(box.max);
  columns_ = last.column + 1;
  rows_ = last.row + 1;
  make_tiles(cloud_H);
  top_.assign(corners_.size() * kTileCells, kNothing);
  for (const Point& p : cloud_H) {
    float& top = top_[place_of(cell_of(p))];
    top = std::max(top, p.z());
  }
  find_horizons();
  find_holds();
  find_insides();
  smooth_rims();
  number_holds();
  raise_covers_place();
  find_tall_columns();
}

/// Clamped to a million cells, far outside of any map, so that sums with cell numbers cannot overflow.
Relief::Cell Relief::cell_of(const Point& p) const {
  const auto cell = [](float v) { return static_cast<int>(std::floor(std::clamp(v, -1e6F, 1e6F))); };
  return {cell((p.x() - corner_.x()) / kCell), cell((p.y() - corner_.y()) / kCell)};
}

/// Stores a tile if a point lies in it or in a cell beside it: callers also ask at the mean of a few points,
/// which may lie in the next cell. Stores an empty tile if tiles with points lie within kReach on all four
/// sides: the floor of a hold that no survey saw. There are at most five of these for each tile with points.
void Relief::make_tiles(std::span<const Point> cloud_H) {
  BlockIndex with_points;
  std::vector<Cell> tiles;
  BlockIndex kept;
  const auto keep = [&](int column, int row) {
    if (kept.add(column, row, 0) == tiles.size()) {
      tiles.push_back({column, row});
    }
  };
  for (const Point& p : cloud_H) {
    const Cell c = cell_of(p);
    with_points.add(c.column >> kTileBits, c.row >> kTileBits, 0);
    for (const int row : {c.row - 1, c.row + 1}) {
      for (const int column : {c.column - 1, c.column + 1}) {
        keep(column >> kTileBits, row >> kTileBits);
      }
    }
  }
  const auto any = [&](Cell tile, int dc, int dr) {
    for (int i = 1; i <= kFarTiles; ++i) {
      if (with_points.find(tile.column + i * dc, tile.row + i * dr, 0) != BlockIndex::kNone) {
        return true;
      }
    }
    return false;
  };
  for (std::size_t i = 0, all = tiles.size(); i < all; ++i) {
    Cell tile = tiles[i];
    if (with_points.find(tile.column, tile.row, 0) == BlockIndex::kNone) {
      continue;
    }
    for (int step = 1; step <= kFarTiles; ++step) {
      ++tile.column;
      if (with_points.find(tile.column, tile.row, 0) != BlockIndex::kNone) {
        break;
      }
      if (any(tile, 1, 0) && any(tile, 0, 1) && any(tile, 0, -1)) {
        keep(tile.column, tile.row);
      }
    }
  }
  std::sort(tiles.begin(), tiles.end(),
            [](Cell a, Cell b) { return std::pair(a.row, a.column) < std::pair(b.row, b.column); });
  for (const Cell& tile : tiles) {
    tiles_.add(tile.column, tile.row, 0);
    corners_.push_back({tile.column * kTile, tile.row * kTile});
  }
}

/// Calls visit(cell, place_of(cell)) for all stored cells inside the map's rectangle, row by row.
template <typename Visit>
void Relief::for_each_cell(Visit&& visit) const {
  for (std::size_t begin = 0, end = 0; begin < corners_.size(); begin = end) {
    while (end < corners_.size() && corners_[end].row == corners_[begin].row) {
      ++end;
    }
    for (int row = 0; row < kTile; ++row) {
      for (std::size_t tile = begin; tile < end; ++tile) {
        for (int column = 0; column < kTile; ++column) {
          const Cell c{corners_[tile].column + column, corners_[tile].row + row};
          if (inside(c)) {
            visit(c, tile * kTileCells + in_tile(c));
          }
        }
      }
    }
  }
}

/// Copies `values` of the stored tiles up to `reach` tiles from `tile` into the window, so that loops need no
/// look-up for each cell. Cells of tiles that are not stored get the window's `nothing`.
template <typename T>
void Relief::look_around(const std::vector<T>& values, std::size_t tile, int reach, Window<T>& window) const {
  const Cell middle{corners_[tile].column >> kTileBits, corners_[tile].row >> kTileBits};
  Cell low = middle;
  Cell high = middle;
  std::vector<std::pair<Cell, std::uint32_t>> near;
  for (int row = middle.row - reach; row <= middle.row + reach; ++row) {
    for (int column = middle.column - reach; column <= middle.column + reach; ++column) {
      if (const std::uint32_t number = tiles_.find(column, row, 0); number != BlockIndex::kNone) {
        near.push_back({{column, row}, number});
        low = {std::min(low.column, column), std::min(low.row, row)};
        high = {std::max(high.column, column), std::max(high.row, row)};
      }
    }
  }
  window.first = {low.column * kTile, low.row * kTile};
  window.columns = (high.column - low.column + 1) * kTile;
  window.rows = (high.row - low.row + 1) * kTile;
  window.values.assign(static_cast<std::size_t>(window.columns) * static_cast<std::size_t>(window.rows),
                       window.nothing);
  for (const auto& [place, number] : near) {
    for (int row = 0; row < kTile; ++row) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(number * kTileCells) + row * kTile;
      std::copy_n(from, kTile,
                  window.values.begin() + ((place.row - low.row) * kTile + row) * window.columns +
                      (place.column - low.column) * kTile);
    }
  }
}

/// Per tile: 1 if it has no point and one of its four sides has none within kReach. Its cells then have no
/// horizon.
std::vector<std::uint8_t> Relief::open_tiles() const {
  std::vector<std::uint8_t> bare(corners_.size());
  for (std::size_t tile = 0; tile < corners_.size(); ++tile) {
    const auto first = top_.begin() + static_cast<std::ptrdiff_t>(tile * kTileCells);
    bare[tile] = std::all_of(first, first + kTileCells, [](float top) { return top == kNothing; }) ? 1 : 0;
  }
  const auto nothing = [&](std::size_t from, int dc, int dr) {
    for (int i = 0; i <= kFarTiles; ++i) {
      const std::uint32_t tile = tiles_.find((corners_[from].column >> kTileBits) + i * dc,
                                             (corners_[from].row >> kTileBits) + i * dr, 0);
      if (tile != BlockIndex::kNone && bare[tile] == 0) {
        return false;
      }
    }
    return true;
  };
  std::vector<std::uint8_t> open(corners_.size());
  for (std::size_t tile = 0; tile < corners_.size(); ++tile) {
    const bool is_open =
        nothing(tile, 1, 0) || nothing(tile, -1, 0) || nothing(tile, 0, 1) || nothing(tile, 0, -1);
    open[tile] = is_open ? 1 : 0;
  }
  return open;
}

void Relief::find_horizons() {
  horizon_.assign(top_.size(), kNothing);
  Window<float> around(kNothing);
  // Lowers the horizons of a line of the tile's cells to what they see along it; kNothing without a point
  // within kReach. The line has n cells inside of the tile. Cell i of it sees the cells behind it in the
  // tile, all cells from n to `steps` after the line's first, which every cell of the line sees, and i cells
  // more.
  const auto lower_along = [&](std::size_t tile, Cell first, int dc, int dr) {
    const auto inside = [](int v) { return v >= 0 && v < kTile; };
    const auto seen = [&](int i) {
      return around.at(
          {corners_[tile].column + first.column + i * dc, corners_[tile].row + first.row + i * dr});
    };
    const float stride = dc != 0 && dr != 0 ? std::sqrt(2.0F) * kCell : kCell;
    const int steps = static_cast<int>(kReach / stride);
    int n = 1;
    while (inside(first.column + n * dc) && inside(first.row + n * dr)) {
      ++n;
    }
    const auto horizon = [&](int i) -> float& {
      return horizon_[tile * kTileCells + in_tile({first.column + i * dc, first.row + i * dr})];
    };
    bool any = false;
    for (int i = 0; i < n; ++i) {
      any = any || horizon(i) != kNothing;
    }
    if (!any) {
      return;
    }
    float common = kNothing;
    for (int i = n; i <= steps; ++i) {
      common = std::max(common, seen(i));
    }
    std::array<float, kTile> behind;
    behind[static_cast<std::size_t>(n - 1)] = kNothing;
    for (int i = n - 1; i > 0; --i) {
      behind[static_cast<std::size_t>(i - 1)] = std::max(behind[static_cast<std::size_t>(i)], seen(i));
    }
    float more = kNothing;
    for (int i = 0; i < n; ++i) {
      more = i > 0 ? std::max(more, seen(steps + i)) : more;
      horizon(i) = std::min(horizon(i), std::max({common, behind[static_cast<std::size_t>(i)], more}));
    }
  };
  const std::vector<std::uint8_t> open = open_tiles();
  for (std::size_t tile = 0; tile < corners_.size(); ++tile) {
    if (open[tile] != 0) {
      continue;
    }
    look_around(top_, tile, kFarTiles, around);
    std::fill_n(horizon_.begin() + static_cast<std::ptrdiff_t>(tile * kTileCells), kTileCells, kNowhere);
    for (const auto& [dc, dr] : kDirections) {
      for (int i = 0; i < kTile; ++i) {
        // Lines begin at the tile's edge that looks against the direction, a diagonal one's at two edges.
        const int edge_column = dc > 0 ? 0 : kTile - 1;
        const int edge_row = dr > 0 ? 0 : kTile - 1;
        if (dc != 0) {
          lower_along(tile, {edge_column, i}, dc, dr);
        }
        if (dr != 0 && (dc == 0 || i != edge_column)) {
          lower_along(tile, {i, edge_row}, dc, dr);
        }
      }
    }
  }
}

bool Relief::in_hold(const Point& p) const { return at(horizon_, cell_of(p), kNothing) >= p.z() + kDepth; }

void Relief::find_holds() {
  rim_height_.assign(top_.size(), kNoRim);
  std::vector<Cell> grown;
  for_each_cell([&](Cell c, std::size_t place) {
    if (top_[place] != kNothing && horizon_[place] >= top_[place] + kDepth) {
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
      const std::size_t place = place_of(c);
      if (place != kNoPlace && top_[place] == kNothing && std::isnan(rim_height_[place]) &&
          horizon_[place] != kNothing) {
        rim_height_[place] = horizon_[place];
        grown.push_back(c);
      }
    }
  }
}

void Relief::find_insides() {
  inside_hold_.assign(rim_height_.size(), 0);
  tile_has_hold_.assign(corners_.size(), 0);
  for_each_cell([&](Cell c, std::size_t place) {
    if (!std::isnan(rim_height_[place]) &&
        std::all_of(kDirections.begin(), kDirections.end(), [&](const auto& d) {
          return !std::isnan(at(rim_height_, {c.column + d.first, c.row + d.second}, kNoRim));
        })) {
      inside_hold_[place] = 1;
      tile_has_hold_[place / kTileCells] = 1;
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
  const int reach = cells(kCoversReach) / kStride * kStride;
  const std::vector<float> rims = rims_of_insides();
  Window<float> window(kNoRim);
  std::vector<float> around;
  for (std::size_t tile = 0; tile < corners_.size(); ++tile) {
    if (tile_has_hold_[tile] == 0) {
      continue;
    }
    look_around(rims, tile, 1, window);
    for (std::size_t i = 0; i < kTileCells; ++i) {
      const std::size_t place = tile * kTileCells + i;
      if (inside_hold_[place] == 0) {
        continue;
      }
      const Cell c{corners_[tile].column + static_cast<int>(i) % kTile,
                   corners_[tile].row + static_cast<int>(i) / kTile};
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
  hold_.assign(top_.size(), kNoHold);
  std::uint32_t holds = 0;
  std::vector<Cell> grown;
  for_each_cell([&](Cell first, std::size_t) {
    const auto join = [&](Cell c) {
      const std::size_t place = place_of(c);
      if (place != kNoPlace && inside_hold_[place] != 0 && hold_[place] == kNoHold) {
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

/// Finds for each cell the lowest rim within kCoversReach along both axes: the minimum along rows first, then
/// along columns. The covers' place begins kOnRim above it.
void Relief::raise_covers_place() {
  covers_from_.assign(top_.size(), kNowhere);
  const int reach = cells(kCoversReach) + 1;  // one more: cells inside a hold begin one cell off its edge
  const std::vector<float> rims = rims_of_insides();
  Window<float> window(kNoRim);
  std::vector<float> along_rows;
  for (std::size_t tile = 0; tile < corners_.size(); ++tile) {
    const Cell corner = corners_[tile];
    if (!any_hold({corner.column - reach, corner.row - reach},
                  {corner.column + kTile - 1 + reach, corner.row + kTile - 1 + reach})) {
      continue;
    }
    look_around(rims, tile, 1, window);
    along_rows.assign(static_cast<std::size_t>((kTile + 2 * reach) * kTile), kNowhere);
    for (int row = 0; row < kTile + 2 * reach; ++row) {
      for (int column = 0; column < kTile; ++column) {
        float& least = along_rows[static_cast<std::size_t>(row * kTile + column)];
        for (int dc = -reach; dc <= reach; ++dc) {
          const float rim = window.at({corner.column + column + dc, corner.row + row - reach});
          least = std::isnan(rim) ? least : std::min(least, rim + kOnRim);
        }
      }
    }
    for (int row = 0; row < kTile; ++row) {
      for (int column = 0; column < kTile; ++column) {
        float& least = covers_from_[tile * kTileCells + static_cast<std::size_t>(row * kTile + column)];
        for (int i = row; i <= row + 2 * reach; ++i) {
          least = std::min(least, along_rows[static_cast<std::size_t>(i * kTile + column)]);
        }
      }
    }
  }
}

/// Marks cells whose highest point is in the covers' place, and their neighbours: a cover's sides may lean.
void Relief::find_tall_columns() {
  tall_.assign(top_.size(), 0);
  for_each_cell([&](Cell c, std::size_t place) {
    if (top_[place] <= covers_from_[place]) {
      return;
    }
    tall_[place] = 1;
    for (const auto& [dc, dr] : kDirections) {
      const std::size_t beside = place_of({c.column + dc, c.row + dr});
      if (beside != kNoPlace && covers_from_[beside] != kNowhere) {
        tall_[beside] = 1;
      }
    }
  });
}

bool Relief::under_covers_place(const Point& p) const {
  return in_covers_place(p) || at(tall_, cell_of(p), std::uint8_t{0}) != 0;
}

bool Relief::in_covers_place(const Point& p) const { return p.z() > at(covers_from_, cell_of(p), kNowhere); }

std::uint32_t Relief::hold_near(const Point& p, float reach) const {
  const std::optional<Point> over = over_hold_near(p, reach);
  return over ? at(hold_, cell_of(*over), kNoHold) : kNoHold;
}

/// Whether one of the tiles that hold the cells from `low` to `high` has a cell inside a hold.
bool Relief::any_hold(Cell low, Cell high) const {
  for (int row = low.row >> kTileBits; row <= high.row >> kTileBits; ++row) {
    for (int column = low.column >> kTileBits; column <= high.column >> kTileBits; ++column) {
      const std::uint32_t tile = tiles_.find(column, row, 0);
      if (tile != BlockIndex::kNone && tile_has_hold_[tile] != 0) {
        return true;
      }
    }
  }
  return false;
}

std::optional<Point> Relief::over_hold_near(const Point& p, float reach) const {
  const Cell here = cell_of(p);
  const int far = cells(reach);
  std::optional<Point> best;
  if (!any_hold({here.column - far, here.row - far}, {here.column + far, here.row + far})) {
    return best;
  }
  float best2 = reach * reach;
  for (int dr = -far; dr <= far; ++dr) {
    for (int dc = -far; dc <= far; ++dc) {
      const Cell c{here.column + dc, here.row + dr};
      if (const std::size_t place = place_of(c); place == kNoPlace || inside_hold_[place] == 0) {
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

std::size_t Relief::memory() const {
  const std::size_t floats =
      top_.capacity() + horizon_.capacity() + rim_height_.capacity() + covers_from_.capacity();
  return floats * sizeof(float) + hold_.capacity() * sizeof(std::uint32_t) + inside_hold_.capacity() +
         tall_.capacity() + tile_has_hold_.capacity() + corners_.capacity() * sizeof(Cell) + tiles_.memory();
}

}  // namespace hulltrack
