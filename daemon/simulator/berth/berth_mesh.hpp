// The berth around the ship, in W: quay with rails, bollards and fenders; conveyor gallery, towers, sheds,
// masts behind it; the water; a crane. Of these the quay and what is built on it stand still for ever.
//
// Quay edge y = 0 with the ship on its +y side, rail level z = 0, river level kWaterLevel at time 0. Metres.
// Pure.
#pragma once

#include "daemon/simulator/sensing/mesh.hpp"

namespace hulltrack {

inline constexpr float kWaterLevel = -5.0F;  // z in W

/// Everything that is built: what a map of the quay shows.
[[nodiscard]] TriangleMesh berth_mesh();
[[nodiscard]] TriangleMesh water_mesh();

/// A mobile crane at x = 0 on the strip between quay edge and rails, its jib over the ship's deck edge and a
/// load on the hook.
[[nodiscard]] TriangleMesh crane_mesh();

}  // namespace hulltrack
