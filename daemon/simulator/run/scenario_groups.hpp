// The two halves of the list of scenarios: about the ship, and about seeing her.
#pragma once

#include <vector>

#include "daemon/simulator/run/scenario.hpp"

namespace hulltrack {

/// Each adds its scenarios to `all`.
void add_ship_scenarios(std::vector<Scenario>& all);
void add_view_scenarios(std::vector<Scenario>& all);

}  // namespace hulltrack
