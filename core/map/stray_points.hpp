// Which points of a map lie far from the ship and are next to nothing of it? A survey's stray returns, the
// (0, 0, 0) of a firing without one, a sentinel such as 9999.
//
// They would lengthen the ship (HullMap::length()) and are no part of her. Pieces of the cloud are told apart
// by coarse cells. Any frame; metres, points finite and within 100 km of the origin. No failure. Cost: some 5
// ns a point, 50 ns where there is more than one piece.
#pragma once

#include <cstddef>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct StrayPoints {
  std::size_t count = 0;
  double nearest = 0.0;  // m from the box around what stays; 0 without strays
  double farthest = 0.0;
};

/// Takes out the pieces that lie apart from the largest by at least kStrayApart, if all of these together
/// hold at most kStrayShare of the map's surface: what is more may be ship, and stays. The others keep their
/// order.
[[nodiscard]] StrayPoints take_out_strays(Cloud& cloud);

/// As long as the longest hatch, the largest thing on a ship that a survey may leave a gap for.
inline constexpr float kStrayApart = 25.0F;  // m
/// No share that a pose is judged by moves by more: the smallest tolerance is 5 % (seen through).
inline constexpr double kStrayShare = 0.01;

}  // namespace hulltrack
