// Which ship lies at the berth? The parameters of a bulk carrier, and the designs that scenarios use.
//
// Ship coordinates: x forward from amidships, y to port from the centre line, z up from the main deck
// amidships; metres. Plain data, no failure.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// Where a hatch's covers are: folded up at one end of the opening, or closed over it.
enum class Covers : std::uint8_t { aft, forward, closed };

/// A hatch opening with its coaming and covers.
struct Hatch {
  float centre;          // x of the middle, m
  float length;          // along the ship, m
  float width;           // across, m
  float coaming_height;  // above the deck, m
  Covers covers;
  float cover_height;     // of the folded covers above the coaming, m
  std::uint64_t details;  // of which coaming stays and covers: the same number, the same ones
};

struct ShipDesign {
  float length = 120.0F;
  float beam = 20.0F;
  float depth = 10.0F;        // keel to main deck
  float bow_length = 18.0F;   // of the part that tapers to the stem
  float stern_length = 8.0F;  // of the part that tapers to the transom
  float forecastle_height = 2.3F;
  float house_length = 12.0F;
  float house_height = 11.0F;
  float house_aft_end = -57.5F;  // x
  float tank_top = -8.6F;        // z of the hold floor
  float side_tank_width = 1.4F;  // hull side to hold side
  std::vector<Hatch> hatches;
  std::vector<Hatch> fitted_around;  // the hatches that rails and fittings were laid out for
  std::uint64_t fittings_seed = 1;   // where vents, winches, lockers stand: no two ships alike
};

/// A river and coastal bulk carrier of 120 x 20 m with four hatches: the ship of the map.
[[nodiscard]] ShipDesign berth_ship();

/// Another ship of the same trade: 127 x 21 m, five hatches elsewhere, house and fittings of its own.
[[nodiscard]] ShipDesign stranger_ship();

/// Sisters of berth_ship(), alike but for 10 to 30 cm: where the hatches are along the ship, how high the
/// coamings are, how long and wide the openings are.
[[nodiscard]] ShipDesign sister_with_other_hatch_places();
[[nodiscard]] ShipDesign sister_with_other_coamings();
[[nodiscard]] ShipDesign sister_with_other_openings();

/// berth_ship() after the crew has closed two hatches and folded the covers of the others up at their other
/// ends.
[[nodiscard]] ShipDesign ship_with_moved_covers();

/// Half of the hull's breadth at deck level, m; 0 beyond the ends.
[[nodiscard]] float half_breadth(const ShipDesign& ship, float x);

/// z of the weather deck at x: sheer towards the ends, the forecastle on top of it.
[[nodiscard]] float deck_height(const ShipDesign& ship, float x);

/// A corner of the second hatch's coaming top on the starboard side, forward: easy to find on the ship.
[[nodiscard]] Point landmark(const ShipDesign& ship);

}  // namespace hulltrack
