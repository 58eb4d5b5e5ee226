// Pieces of a ship that prove which ship it is: flat patches of a few metres and the rims of its hatches.
//
// A patch is connected, coplanar and not larger than kTile, so that the bending of a hull by centimetres
// moves it as a whole. Left out is what another day may look otherwise on the same ship: what lies in a pit
// (cargo's place) and what stands higher than a hatch's rim beside it (covers' place), down to the deck.
// Frame H, metres. Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "core/kdtree/kdtree.hpp"
#include "core/map/coaming.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

enum class PatchKind : std::uint8_t { surface, coaming_wall, rim };

struct MapPatch {
  PatchKind kind = PatchKind::surface;
  SurfaceClass faces = SurfaceClass::other;  // of a rim: its edges
  float place = 0.0F;                        // m: its middle, along the axis that it faces
  std::uint32_t pit = Relief::kNoPit;        // of the hatch that it belongs to
};

inline constexpr float kTile = 4.0F;  // m

/// Finds out which planar surfels have another surface behind them (Surfel::backed); surfels as of
/// compute_surfels().
void orient_surfels(const Cloud& points_H, const KdTree& map, std::vector<Surfel>& surfels);

/// Gives planar surfels and rim points the number of their patch, the surfels of a patch one side, and
/// measures the rims; returns the patches by number.
[[nodiscard]] std::vector<MapPatch> number_patches(const Cloud& points_H, const KdTree& map,
                                                   const Relief& relief, std::vector<Surfel>& surfels,
                                                   std::vector<RimPoint>& rims);

}  // namespace hulltrack
