// The map seen from above: where are its open holds, and how high are their rims?
//
// A pit is a place with structure at least kDepth higher in every level direction within kReach: inside of an
// open hatch. What lies in it is cargo's place, what stands on its rim is the covers' place: neither says
// which ship this is. Frame H, metres. Immutable. No failure: a map without pits has none.
// Cost: some 0.1 s for a ship of 200 m.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

class Relief {
 public:
  static constexpr float kCell = 0.25F;   // m
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
    const Cell c = cell_of(p);
    return inside(c) ? rim_[index(c)] : std::numeric_limits<float>::quiet_NaN();
  }

  static constexpr std::uint32_t kNoPit = 0xFFFFFFFFU;
  /// Number of the pit that is nearest to p within `reach` (m); kNoPit where there is none.
  [[nodiscard]] std::uint32_t pit_near(const Point& p, float reach) const;

  /// A point at p's height over the nearest pit within `reach` (m), a cell inside of its rim.
  [[nodiscard]] std::optional<Point> over_pit_near(const Point& p, float reach) const;

 private:
  struct Cell {
    int column, row;
  };
  [[nodiscard]] Cell cell_of(const Point& p) const;
  [[nodiscard]] bool inside(Cell c) const {
    return c.column >= 0 && c.column < columns_ && c.row >= 0 && c.row < rows_;
  }
  [[nodiscard]] std::size_t index(Cell c) const {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(c.column);
  }
  [[nodiscard]] float lowest_horizon(Cell from) const;
  void find_horizons();
  void find_pits();
  void find_insides();
  void smooth_rims();
  void number_pits();
  void raise_covers_place();
  void find_tall_columns();

  Point corner_ = Point::Zero();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> top_;          // per cell: its highest point; -infinity without one
  std::vector<float> horizon_;      // per cell: the least, over all directions, of the highest structure
  std::vector<float> rim_;          // per cell of a pit: the height of its rim; NaN elsewhere
  std::vector<bool> inside_pit_;    // per cell: it and the eight around it are pit
  std::vector<std::uint32_t> pit_;  // per cell inside of one: its number; kNoPit elsewhere
  std::vector<bool> tall_;          // per cell: it or one around it reaches into the covers' place
  std::vector<float> covers_from_;  // per cell: above this height is the covers' place; infinity = nowhere
};

}  // namespace hulltrack
