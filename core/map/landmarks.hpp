// Pieces of a ship that prove which ship it is: flat landmarks, and pieces of the tops of its coamings.
//
// A landmark is a connected group of surfels on one plane, or of rim points (coaming.hpp), within a cube of
// kTile. A hull that bends by centimetres moves so small a piece as a whole. Surfels are left out where the
// same ship may look different on another day: in holds, where cargo lies, and where hatch covers may stand,
// down to the deck (relief.hpp).
// Frame H, metres. Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "core/kdtree/kdtree.hpp"
#include "core/map/coaming.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

enum class LandmarkKind : std::uint8_t { surface, coaming_wall, rim };

struct Landmark {
  LandmarkKind kind = LandmarkKind::surface;
  SurfaceClass faces = SurfaceClass::other;  // of a rim: the direction across the rim, not of its level top
  float place = 0.0F;                        // m: mean coordinate along the axis that it faces
  std::uint32_t hold = Relief::kNoHold;      // hold of the hatch that it belongs to: within kRimReach of it
};

inline constexpr float kTile = 4.0F;  // m: side of the cubes at whose borders landmarks end

/// `surfels` with sides: planar ones become Surfel::backed if the map has something close to one side of them
/// only, and their normals point to the free side. `surfels`: as compute_surfels() gives them; `map`: the
/// tree over the map.
[[nodiscard]] std::vector<Surfel> oriented_surfels(const Cloud& points_H, const KdTree& map,
                                                   std::vector<Surfel> surfels);

/// What of a map is a landmark, and the surfels and rim points that know it.
struct LandmarkedMap {
  std::vector<Landmark> landmarks;  // by number
  std::vector<Surfel> surfels;
  std::vector<RimPoint> rims;
};

/// Finds the landmarks among oriented surfels and the points of find_rims(). Surfels come back with `movable`
/// and `landmark`; their normals turned to one side of their landmark, of a coaming's wall away from the
/// rim's middle (a wall is not seen from within the coaming). Rim points come back measured. `points_H`: the
/// point of each surfel.
[[nodiscard]] LandmarkedMap find_landmarks(const Cloud& points_H, const KdTree& map, const Relief& relief,
                                           std::vector<Surfel> surfels, std::vector<RimPoint> rims);

}  // namespace hulltrack
