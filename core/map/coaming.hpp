// The coamings of a ship's hatches: their tops, which are strips, and the walls that carry these.
//
// A coaming is welded to the deck: a top that lies aside of its place, or a wall that stands behind its own,
// is another ship's. Found along the pits of the relief. A coaming's top is too narrow for the surfels of
// the metric subset and has finer points of its own.
// Frame H, metres. Pure functions; cost: some 5 us a map point near a rim.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/kdtree/kdtree.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

/// A point in the middle of a coaming's top.
struct RimPoint {
  Point p_H;
  Point over_hold_H;   // at the same height, where the open hold is
  Point across_H;      // level unit vector across the strip towards the hold
  float begin = 0.0F;  // edges of the strip from p_H along across_H, m; both 0: not known
  float end = 0.0F;
  std::uint32_t patch = Surfel::kNoPatch;
  [[nodiscard]] bool is_measured() const { return patch != Surfel::kNoPatch && begin < end; }
};

inline constexpr float kRimReach = 1.0F;            // m: a coaming with its rest bar is not broader
inline constexpr std::size_t kFewestRimPoints = 5;  // a metre of rim

/// The rims of all pits of the map.
[[nodiscard]] std::vector<RimPoint> find_rims(const Cloud& cloud_H, const KdTree& map, const Relief& relief);

/// Brings numbered rim points onto the middle line of their strips and finds the edges.
void measure_rims(const KdTree& map, std::vector<RimPoint>& rims);

/// Which of `patches` patches are walls under an edge of a measured rim. Turns their surfels' normals away
/// from the coaming's inside: from there nobody sees them (Surfel::backed).
[[nodiscard]] std::vector<bool> find_coaming_walls(std::span<const RimPoint> rims, std::uint32_t patches,
                                                   std::vector<Surfel>& surfels);

}  // namespace hulltrack
