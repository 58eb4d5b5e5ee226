// Builds a kd-tree: a good one for a map, or one quickly for a scan.
//
// build() works from the top down. It splits each range of points at its exact median rank, along the longest
// side of the range's tight box. A histogram along that side tells which bin holds the median. Points are
// then moved once into a second buffer: below, in or above that bin, without a branch that depends on the
// data. Only the points of that bin are sorted by comparison. Exact ranks keep all leaves full and at one
// depth.
// Frames: the cloud's. Cannot fail. Cost: O(n log n); twice 16 bytes a point while building.
#pragma once

#include <span>

#include "core/geometry/cloud.hpp"
#include "core/kdtree/kdtree_layout.hpp"

namespace hulltrack::kdtree {

/// A layout over the finite points of `cloud` (at most 2^31). The same cloud gives the same layout.
[[nodiscard]] Layout build(std::span<const Point> cloud);

/// A layout in less than half of the time, for few searches: points are sorted along a space-filling curve
/// and packed into leaves and nodes from the bottom up. Boxes are less tight where the curve jumps, so that
/// searches take longer; the answers are the same.
[[nodiscard]] Layout build_along_curve(std::span<const Point> cloud);

}  // namespace hulltrack::kdtree
