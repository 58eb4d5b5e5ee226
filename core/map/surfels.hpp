// Normals, flatness and classes of chosen map points, from the map around them.
//
// Principal component analysis of the map points within kSurfelRadius. A point is planar if these lie on a
// plane, spread in both directions of it, and have their centroid near the point (beside an edge they do
// not).
// Frame H, metres. Cost: about 1 us a point of a 5 cm map (kd-tree, 3x3 solver).
#pragma once

#include <vector>

#include "core/kdtree/kdtree.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

inline constexpr float kSurfelRadius = 0.3F;  // m

/// One surfel for each of `points_H`; `map` is the tree over the map's cloud. Sets neither Surfel::movable,
/// backed nor landmark (landmarks.hpp).
[[nodiscard]] std::vector<Surfel> compute_surfels(const Cloud& points_H, const KdTree& map);

}  // namespace hulltrack
