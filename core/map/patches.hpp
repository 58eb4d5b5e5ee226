// Pieces of a ship that prove which ship it is: flat patches of a few metres and the rims of its hatches.
//
// A patch is connected, coplanar and not larger than kTile, so that the bending of a hull by centimetres
// moves it as a whole. Left out is what another day may look otherwise on the same ship: what lies in a pit
// (cargo's place) and what stands higher than a hatch's rim beside it (covers' place). A coaming's top is too
// narrow for the surfels of the metric subset and has finer ones of its own.
// Frame H, metres. Pure functions; cost: some 5 us a rim's map point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"
#include "core/search/kdtree.hpp"

namespace hulltrack {

/// A point in the middle of a coaming's top, which is a strip.
struct RimPoint {
  Point p_H;
  Point over_hold_H;   // at the same height, where the open hold is
  Point across_H;      // level unit vector across the strip towards the hold
  float begin = 0.0F;  // edges of the strip from p_H along across_H, m; both 0: not known
  float end = 0.0F;
  std::uint32_t patch = Surfel::kNoPatch;
};

inline constexpr float kTile = 4.0F;  // m

/// The rims of all pits of the map.
[[nodiscard]] std::vector<RimPoint> find_rims(const Cloud& cloud_H, const KdTree& map, const Relief& relief);

/// Finds out which planar surfels have another surface behind them (Surfel::backed); surfels as of
/// compute_surfels().
void orient_surfels(const Cloud& points_H, const KdTree& map, std::vector<Surfel>& surfels);

/// Gives planar surfels and rim points the number of their patch, and the surfels of a patch one side;
/// returns how many patches there are.
std::uint32_t number_patches(const Cloud& points_H, std::vector<Surfel>& surfels, std::vector<RimPoint>& rims,
                             const Relief& relief);

/// Brings numbered rim points onto the middle line of their strips and finds the edges.
void measure_rims(const KdTree& map, std::vector<RimPoint>& rims);

}  // namespace hulltrack
