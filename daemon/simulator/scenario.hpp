// Which story does a simulation tell? Named scenarios: what the ship does, which ship it is, how long.
//
// Magnitudes and their sources: hulltrack(1), section SIMULATE. Plain data, no failure.
#pragma once

#include <string_view>
#include <vector>

#include "daemon/simulator/hull_motion.hpp"
#include "daemon/simulator/ship_design.hpp"

namespace hulltrack {

struct Scenario {
  std::string_view name;
  std::string_view sentence;  // for --list
  int frames;                 // of a run whose length nobody chose, at 10 Hz
  HullMotionConfig motion;
  ShipDesign ship_at_berth;  // the map is always of berth_ship()
  double cargo_fill;         // what has been poured since the map was made, [0, 1]
};

[[nodiscard]] const std::vector<Scenario>& scenarios();

/// nullptr when there is none of that name.
[[nodiscard]] const Scenario* find_scenario(std::string_view name);

}  // namespace hulltrack
