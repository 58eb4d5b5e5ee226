// How is a kd-tree built: well for a map, quickly for a scan?
//
// Top down, each range split at its exact median rank along the longest side of its tight box. The rank
// is found by a histogram along that side and the points move once a split into a second buffer, without
// a branch that depends on the data; only the one bin that holds the rank is sorted out by comparison.
// Exact ranks keep all leaves full and at one depth. Frames: the cloud's; no failure.
// Cost: O(n log n); twice 16 bytes a point while building.
#pragma once

#include <span>

#include "core/geometry/cloud.hpp"
#include "core/kdtree/kdtree_layout.hpp"

namespace hulltrack::kdtree {

/// A layout over the finite points of `cloud` (at most 2^31). The same cloud gives the same layout.
[[nodiscard]] Layout build(std::span<const Point> cloud);

/// The same in less than half of the time, for a tree that is asked little: points are sorted along a
/// space-filling curve and packed bottom up. Boxes are less tight where the curve jumps; answers are the
/// same, searches dearer.
[[nodiscard]] Layout build_along_curve(std::span<const Point> cloud);

}  // namespace hulltrack::kdtree
