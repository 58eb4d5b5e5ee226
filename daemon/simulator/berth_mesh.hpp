// The berth around the ship, in W: quay with fenders and bollards, rails, a conveyor gallery, a stockpile,
// a shed, the water. Everything here is clutter to the tracker.
//
// Quay edge y = 0 with the ship on its +y side, rail level z = 0, river level kWaterLevel. Metres. Pure.
#pragma once

#include "daemon/simulator/mesh.hpp"

namespace hulltrack {

inline constexpr float kWaterLevel = -5.0F;  // z in W

[[nodiscard]] TriangleMesh berth_mesh();

}  // namespace hulltrack
