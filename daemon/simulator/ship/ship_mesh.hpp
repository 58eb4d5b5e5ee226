// What does the ship look like to a laser? The triangles of a bulk carrier.
//
// Ship coordinates as in ship_design.hpp, metres. Pure: the same design gives the same triangles.
#pragma once

#include "daemon/simulator/sensing/mesh.hpp"
#include "daemon/simulator/ship/ship_design.hpp"

namespace hulltrack {

/// The whole ship with empty holds: shell, decks, bulwark and rails, hatches, house, fittings.
[[nodiscard]] TriangleMesh ship_mesh(const ShipDesign& ship);

/// What loading has put into the holds so far: a heap in each, `fill` in [0, 1] of the hold's depth,
/// differing from hold to hold.
[[nodiscard]] TriangleMesh cargo_mesh(const ShipDesign& ship, float fill);

/// Parts of ship_mesh, added to `mesh`.
void add_hatch(TriangleMesh& mesh, const ShipDesign& ship, const Hatch& hatch);
void add_house(TriangleMesh& mesh, const ShipDesign& ship);
void add_fittings(TriangleMesh& mesh, const ShipDesign& ship);

}  // namespace hulltrack
