// The map seen from above: where are its open holds, and how high are their rims?
//
// Each level cell of the map (level_cells.hpp) has the height of its highest point, and a horizon
// (horizons.hpp).
//   hold:          cells whose horizon is at least kDepth above their highest point: an open hatch.
//   inside:        a cell of a hold whose eight neighbours are hold, too.
//   rim height:    of the top of the coaming around a hold. It comes from the horizons in the hold.
//   covers' place: what is higher than a rim and within kCoversReach of its hold. Hatch covers stand there.
// Cargo in holds and covers in their place change from day to day: they do not tell which ship this is.
// Input in frame H, metres, within 100 km of the origin. Immutable. Cannot fail: a map without holds has
// none. Cost: some 0.1 s for a ship of 200 m; 5 kB a tile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/map/covers_place.hpp"
#include "core/map/level_cells.hpp"

namespace hulltrack {

class Relief {
 public:
  static constexpr float kDepth = 2.0F;  // m: the deck is less than this below coamings and bulwark

  explicit Relief(std::span<const Point> cloud_H);

  /// Whether p lies kDepth or more below the horizon of its cell.
  [[nodiscard]] bool in_hold(const Point& p) const;

  /// Whether p stands higher than the lowest rim of the holds within kCoversReach.
  [[nodiscard]] bool in_covers_place(const Point& p) const;

  /// Whether p is in the covers' place, or in or beside a cell whose highest point is. Covers folded beside a
  /// hatch may reach down to the deck; when they are moved, the surfaces behind them come into view.
  [[nodiscard]] bool under_covers_place(const Point& p) const;

  /// Height of the rim of the hold in whose cells p lies, seen from above, m; NaN where there is no hold.
  [[nodiscard]] float rim_height_around(const Point& p) const {
    return cells_.at(rim_height_, cells_.cell_of(p), std::numeric_limits<float>::quiet_NaN());
  }

  static constexpr std::uint32_t kNoHold = 0xFFFFFFFFU;
  /// Number of the hold that is nearest to p within `reach` (m) on the level; kNoHold where there is none.
  [[nodiscard]] std::uint32_t hold_near(const Point& p, float reach) const;

  /// The middle of the nearest cell inside a hold within `reach` (m), at p's height; nothing without one.
  [[nodiscard]] std::optional<Point> over_hold_near(const Point& p, float reach) const;

  /// Heap memory that this holds, bytes.
  [[nodiscard]] std::size_t memory() const;

 private:
  using Cell = LevelCells::Cell;

  void find_holds(const std::vector<float>& top);
  void find_insides();
  void smooth_rims();
  void number_holds();
  [[nodiscard]] std::vector<float> rims_of_insides() const;
  [[nodiscard]] bool any_hold(Cell low, Cell high) const;

  LevelCells cells_;
  // Per cell, in the order of LevelCells::place_of():
  std::vector<float> horizon_;               // find_horizons()
  std::vector<float> rim_height_;            // in a hold, m; NaN elsewhere
  std::vector<std::uint8_t> inside_hold_;    // 1: it and its eight neighbours are hold
  std::vector<std::uint32_t> hold_;          // inside a hold: the hold's number; kNoHold elsewhere
  std::vector<std::uint8_t> tall_;           // 1: its highest point, or a neighbour's, is in covers' place
  std::vector<float> covers_from_;           // covers' place begins at this height, m; infinity = not here
  std::vector<std::uint8_t> tile_has_hold_;  // per tile: 1 if one of its cells is inside a hold
};

}  // namespace hulltrack
