// The coamings of a ship's hatches: their tops and the walls that carry the tops.
//
// A coaming is welded to the deck. If its top or its wall is seen in another place, this is another ship.
// A rim is the top of one straight piece of the coaming around a hold (relief.hpp), between its two edges. It
// is too narrow for the surfels of the metric subset and has a row of finer points of its own, those of one
// landmark.
// Steps: find_rims(), landmark numbers for the rim points (landmarks.hpp), measured_rims(),
// find_coaming_walls(). Frame H, metres. Pure functions. Cost: some 5 us a map point near a rim.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/kdtree/kdtree.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

/// A point on a coaming's top; on the middle line of its rim once this is measured.
struct RimPoint {
  Point p_H;
  Point over_hold_H;   // at about the same height, over the nearest cell inside the hold
  Point across_H;      // level unit vector across the rim towards the hold
  float begin = 0.0F;  // edges of the rim, from p_H along across_H, m; both 0: not known
  float end = 0.0F;
  std::uint32_t landmark = Surfel::kNoLandmark;
  [[nodiscard]] bool is_measured() const { return landmark != Surfel::kNoLandmark && begin < end; }
};

/// A rim lies within this distance of a cell inside its hold, m: a coaming with its rest bar is not broader.
inline constexpr float kRimReach = 1.0F;
inline constexpr std::size_t kFewestRimPoints = 5;  // of a rim: a metre of rim

/// Points on the rims of all holds, without landmark and edges. `map` is the tree over `cloud_H`.
[[nodiscard]] std::vector<RimPoint> find_rims(const Cloud& cloud_H, const KdTree& map, const Relief& relief);

/// `rims` with the edges that the map's points around show. The points of each landmark are moved onto the
/// line through them; those that lie off the line no longer have a landmark.
[[nodiscard]] std::vector<RimPoint> measured_rims(const KdTree& map, std::vector<RimPoint> rims);

/// Which of `landmarks` landmarks are walls of a coaming? For each the sum of the level directions from a
/// rim's middle through the wall; zero for those that are none. A landmark is a wall if most of its surfels
/// lie below an edge of a measured rim, in line with the edge, and face across the rim.
[[nodiscard]] std::vector<Point> find_coaming_walls(std::span<const RimPoint> rims, std::uint32_t landmarks,
                                                    std::span<const Surfel> surfels);

}  // namespace hulltrack
