// The map seen from above: where are its open holds, and how high are their rims?
//
// The map becomes a grid of level cells of kCell x kCell, each with the height of its highest point.
//   horizon:       of a cell. In each of eight level directions the highest point within kReach counts; the
//                  horizon is the lowest of these eight heights.
//   hold:          cells whose horizon is at least kDepth above their highest point: an open hatch.
//   inside:        a cell of a hold whose eight neighbours are hold, too.
//   rim height:    of the top of the coaming around a hold. It comes from the horizons in the hold.
//   covers' place: what is higher than a rim and within kCoversReach of its hold. Hatch covers stand there.
// Cargo in holds and covers in their place change from day to day: they do not tell which ship this is.
// Cells are stored in tiles of kTile x kTile cells, only where the map has points in or beside the tile, or
// on all four sides of it. Input in frame H, metres, within 100 km of the origin. Immutable. Cannot fail: a
// map without holds has none. Cost: some 0.1 s for a ship of 200 m; 6 kB a tile. A point adds at most nine
// tiles, however the points are scattered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/block_index.hpp"
#include "core/geometry/cloud.hpp"

namespace hulltrack {

class Relief {
 public:
  static constexpr float kCell = 0.25F;  // m
  static constexpr int kTileBits = 4;
  static constexpr int kTile = 1 << kTileBits;  // cells
  static constexpr float kDepth = 2.0F;         // m: the deck is less than this below coamings and bulwark
  static constexpr float kReach = 20.0F;        // m: half of the longest hatch
  /// Covers that are folded or rolled away stand up to this far from their hatch, m.
  static constexpr float kCoversReach = 3.0F;

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
    return at(rim_height_, cell_of(p), std::numeric_limits<float>::quiet_NaN());
  }

  static constexpr std::uint32_t kNoHold = 0xFFFFFFFFU;
  /// Number of the hold that is nearest to p within `reach` (m) on the level; kNoHold where there is none.
  [[nodiscard]] std::uint32_t hold_near(const Point& p, float reach) const;

  /// The middle of the nearest cell inside a hold within `reach` (m), at p's height; nothing without one.
  [[nodiscard]] std::optional<Point> over_hold_near(const Point& p, float reach) const;

  /// Heap memory that this holds, bytes.
  [[nodiscard]] std::size_t memory() const;

 private:
  static constexpr std::size_t kTileCells = std::size_t{kTile} * kTile;
  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);

  struct Cell {
    int column, row;
  };
  /// The values of a tile and of the tiles around it, copied into one rectangle of cells.
  template <typename T>
  struct Window;

  [[nodiscard]] Cell cell_of(const Point& p) const;
  [[nodiscard]] bool inside(Cell c) const {
    return c.column >= 0 && c.column < columns_ && c.row >= 0 && c.row < rows_;
  }
  /// Index of the cell in the vectors below; kNoPlace for a cell whose tile is not stored.
  [[nodiscard]] std::size_t place_of(Cell c) const {
    const std::uint32_t tile =
        inside(c) ? tiles_.find(c.column >> kTileBits, c.row >> kTileBits, 0) : BlockIndex::kNone;
    return tile == BlockIndex::kNone ? kNoPlace : tile * kTileCells + in_tile(c);
  }
  [[nodiscard]] static std::size_t in_tile(Cell c) {
    return static_cast<std::size_t>((c.row & (kTile - 1)) * kTile + (c.column & (kTile - 1)));
  }
  template <typename T>
  [[nodiscard]] T at(const std::vector<T>& values, Cell c, T nothing) const {
    const std::size_t place = place_of(c);
    return place == kNoPlace ? nothing : values[place];
  }
  template <typename Visit>
  void for_each_cell(Visit&& visit) const;
  template <typename T>
  void look_around(const std::vector<T>& values, std::size_t tile, int reach, Window<T>& window) const;

  void make_tiles(std::span<const Point> cloud_H);
  [[nodiscard]] std::vector<std::uint8_t> open_tiles() const;
  void find_horizons();
  void find_holds();
  void find_insides();
  void smooth_rims();
  void number_holds();
  void raise_covers_place();
  void find_tall_columns();
  [[nodiscard]] std::vector<float> rims_of_insides() const;
  [[nodiscard]] bool any_hold(Cell low, Cell high) const;

  Point corner_ = Point::Zero();
  int columns_ = 0;  // of the map's bounding rectangle
  int rows_ = 0;
  BlockIndex tiles_;
  std::vector<Cell> corners_;  // per tile: its first cell; row by row

  // Per cell, tile by tile.
  std::vector<float> top_;                   // height of its highest point, m; -infinity without points
  std::vector<float> horizon_;               // m; -infinity if the map has nothing in one of the directions
  std::vector<float> rim_height_;            // in a hold, m; NaN elsewhere
  std::vector<std::uint8_t> inside_hold_;    // 1: it and its eight neighbours are hold
  std::vector<std::uint32_t> hold_;          // inside a hold: the hold's number; kNoHold elsewhere
  std::vector<std::uint8_t> tall_;           // 1: its highest point, or a neighbour's, is in covers' place
  std::vector<float> covers_from_;           // covers' place begins at this height, m; infinity = not here
  std::vector<std::uint8_t> tile_has_hold_;  // per tile: 1 if one of its cells is inside a hold
};

}  // namespace hulltrack
