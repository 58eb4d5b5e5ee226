// The map seen from above: where are its open holds, and how high are their rims?
//
// A pit is a place with structure at least kDepth higher in every level direction within kReach: inside of an
// open hatch. What lies in it is cargo's place, what stands on its rim is the covers' place: neither says
// which ship this is. Seen as cells of kCell, in tiles of kTile x kTile cells that are kept only where the
// map is, or where it is all around. Frame H, metres, within 100 km of the origin. Immutable. No failure: a
// map without pits has none. Cost: some 0.1 s for a ship of 200 m; 6 kB a tile, and six tiles a point at most
// however the points are scattered.
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
  static constexpr float kDepth = 2.0F;   // m: deeper than anything on a deck between coamings and bulwark
  static constexpr float kReach = 20.0F;  // m: half of the longest hatch
  /// As far from a hatch as its covers stand when folded or rolled away, m.
  static constexpr float kCoversReach = 3.0F;

  explicit Relief(std::span<const Point> cloud_H);

  /// Whether p lies kDepth or more below what surrounds it.
  [[nodiscard]] bool in_pit(const Point& p) const;

  /// Whether p stands higher than the rim of a pit within kCoversReach.
  [[nodiscard]] bool in_covers_place(const Point& p) const;

  /// The same, or p is below something that does: covers that are folded beside a hatch may reach down to the
  /// deck, and whoever moves them bares what is behind.
  [[nodiscard]] bool under_covers_place(const Point& p) const;

  /// Height of the rim of the pit that p is over, m; NaN where there is none.
  [[nodiscard]] float rim_around(const Point& p) const {
    return at(rim_, cell_of(p), std::numeric_limits<float>::quiet_NaN());
  }

  static constexpr std::uint32_t kNoPit = 0xFFFFFFFFU;
  /// Number of the pit that is nearest to p within `reach` (m); kNoPit where there is none.
  [[nodiscard]] std::uint32_t pit_near(const Point& p, float reach) const;

  /// A point at p's height over the nearest pit within `reach` (m), a cell inside of its rim.
  [[nodiscard]] std::optional<Point> over_pit_near(const Point& p, float reach) const;

  /// Heap memory that this holds, bytes.
  [[nodiscard]] std::size_t memory() const;

 private:
  static constexpr std::size_t kTileCells = std::size_t{kTile} * kTile;
  static constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);

  struct Cell {
    int column, row;
  };
  /// Tiles that lie around one, side by side.
  template <typename T>
  struct Window;

  [[nodiscard]] Cell cell_of(const Point& p) const;
  [[nodiscard]] bool inside(Cell c) const {
    return c.column >= 0 && c.column < columns_ && c.row >= 0 && c.row < rows_;
  }
  /// Where the cell's values stand; kNoPlace for a cell that has the values of nothing.
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
  void find_pits();
  void find_insides();
  void smooth_rims();
  void number_pits();
  void raise_covers_place();
  void find_tall_columns();
  [[nodiscard]] std::vector<float> rims_of_insides() const;
  [[nodiscard]] bool any_pit(Cell low, Cell high) const;

  Point corner_ = Point::Zero();
  int columns_ = 0;  // of the map's bounding rectangle
  int rows_ = 0;
  BlockIndex tiles_;
  std::vector<Cell> corners_;  // per tile: its first cell; row by row

  // Per cell, tile by tile.
  std::vector<float> top_;                  // its highest point; -infinity without one
  std::vector<float> horizon_;              // the least, over all directions, of the highest structure
  std::vector<float> rim_;                  // of a pit: the height of its rim; NaN elsewhere
  std::vector<std::uint8_t> inside_pit_;    // whether it and the eight around it are pit
  std::vector<std::uint32_t> pit_;          // inside of one: its number; kNoPit elsewhere
  std::vector<std::uint8_t> tall_;          // whether it or one around it reaches into the covers' place
  std::vector<float> covers_from_;          // above this height is the covers' place; infinity = nowhere
  std::vector<std::uint8_t> tile_has_pit_;  // per tile: whether a cell of it is inside of one
};

}  // namespace hulltrack
