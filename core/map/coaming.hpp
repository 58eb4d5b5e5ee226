// The coamings of a ship's hatches: their tops and the walls that carry the tops.
//
// A coaming is welded to the deck. If its top or its wall is seen in another place, this is another ship.
//   rim:   the top of the coaming around a pit (an open hatch, relief.hpp), as a row of points. It is too
//          narrow for the surfels of the metric subset and has these finer points of its own.
//   strip: the top of one straight piece of coaming, between its two edges: the rim points of one patch.
// Steps: find_rims(), patch numbers for the rim points (patches.hpp), measure_rims(), find_coaming_walls().
// Frame H, metres. Pure functions. Cost: some 5 us a map point near a rim.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/kdtree/kdtree.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

/// A point on a coaming's top; on the middle line of its strip once this is measured.
struct RimPoint {
  Point p_H;
  Point over_hold_H;   // at about the same height, over the nearest cell inside the pit
  Point across_H;      // level unit vector across the strip towards the hold
  float begin = 0.0F;  // edges of the strip, from p_H along across_H, m; both 0: not known
  float end = 0.0F;
  std::uint32_t patch = Surfel::kNoPatch;
  [[nodiscard]] bool is_measured() const { return patch != Surfel::kNoPatch && begin < end; }
};

/// A rim lies within this distance of a cell inside its pit, m: a coaming with its rest bar is not broader.
inline constexpr float kRimReach = 1.0F;
inline constexpr std::size_t kFewestRimPoints = 5;  // of a strip: a metre of rim

/// Points on the rims of all pits, without patch and edges. `map` is the tree over `cloud_H`.
[[nodiscard]] std::vector<RimPoint> find_rims(const Cloud& cloud_H, const KdTree& map, const Relief& relief);

/// For the rim points of each patch: moves them onto the line through them, takes the patch from those that
/// lie off the line, and finds the strip's edges from the map's points around.
void measure_rims(const KdTree& map, std::vector<RimPoint>& rims);

/// Which of `patches` patches are walls of a coaming? A patch is one if most of its surfels lie below an edge
/// of a measured rim, in line with the edge, and face across the strip. Their normals are turned away from
/// the strip's middle and they become Surfel::backed: a wall is not seen from within the coaming.
[[nodiscard]] std::vector<bool> find_coaming_walls(std::span<const RimPoint> rims, std::uint32_t patches,
                                                   std::vector<Surfel>& surfels);

}  // namespace hulltrack
