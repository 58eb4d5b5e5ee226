#include "daemon/simulator/run/scenario.hpp"

#include <algorithm>

#include "daemon/simulator/run/scenario_groups.hpp"

namespace hulltrack {
namespace {

std::vector<Scenario> make_scenarios() {
  std::vector<Scenario> all;
  add_ship_scenarios(all);
  add_view_scenarios(all);
  return all;
}

}  // namespace

bool is_clear(const Scenario& scenario) {
  return scenario.weather.when.length == 0.0 && scenario.cover.when.length == 0.0 && scenario.dust == 0.0;
}

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = make_scenarios();
  return all;
}

const Scenario* find_scenario(std::string_view name) {
  const auto found =
      std::find_if(scenarios().begin(), scenarios().end(), [&](const Scenario& s) { return s.name == name; });
  return found == scenarios().end() ? nullptr : &*found;
}

}  // namespace hulltrack
