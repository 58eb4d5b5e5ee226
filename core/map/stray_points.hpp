// Removes the points of a map that lie far from the ship: a survey's stray returns, the (0, 0, 0) of a firing
// without a return, a sentinel such as 9999. They would make the ship longer (HullMap::length()).
//
// The cloud is put into cells of kStrayApart. Occupied cells that touch are one piece, and the piece with the
// most surface is the ship. Any frame; metres, points finite and within 100 km of the origin. Cannot fail.
// Cost: some 5 ns a point, 50 ns where there is more than one piece.
#pragma once

#include <cstddef>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct StrayPoints {
  std::size_t count = 0;
  double nearest = 0.0;  // distances from the box around the points that stay, m; 0 without strays
  double farthest = 0.0;
};

/// Takes all pieces but the largest out of the cloud if they together hold at most kStrayShare of the map's
/// surface. Otherwise they may be parts of the ship, and nothing is taken out. The points that stay keep
/// their order.
[[nodiscard]] StrayPoints take_out_strays(Cloud& cloud);

/// Strays are at least this far from the ship: as far as the longest hatch is long, which is the largest gap
/// that a survey may leave in a ship.
inline constexpr float kStrayApart = 25.0F;  // m
/// Far below the smallest share of the map's surfaces by which a pose is judged: 5 % seen through.
inline constexpr double kStrayShare = 0.01;

}  // namespace hulltrack
