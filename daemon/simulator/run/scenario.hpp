// Which story does a simulation tell? Named scenarios: what the ship does, which ship it is, what is between
// her and the LiDAR, how the loader works, how long.
//
// Magnitudes and their sources: hulltrack(1), section SIMULATE. Plain data, no failure.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "daemon/simulator/berth/berth_world.hpp"
#include "daemon/simulator/berth/loader_machine.hpp"
#include "daemon/simulator/berth/plc_model.hpp"
#include "daemon/simulator/sensing/weather.hpp"
#include "daemon/simulator/ship/hull_motion.hpp"
#include "daemon/simulator/ship/hull_shape.hpp"
#include "daemon/simulator/ship/ship_design.hpp"

namespace hulltrack {

struct Scenario {
  std::string_view name;
  std::string_view sentence;  // for --list
  int frames;                 // of a run whose length nobody chose, at 10 Hz

  HullMotionConfig motion;
  ShipDesign ship_at_berth = berth_ship();  // the map is always of berth_ship()
  bool mapped_ship = true;  // false: health 1 is always wrong, because another ship lies there, or none
  HullShape at_first{.fill = 0.35};  // what has been poured and bent since the map was made
  HullShape at_last = at_first;      // after `frames`

  Weather weather = {};
  WindowCover cover = {};
  double dust = 0.0;  // see DustPlume
  std::optional<Passage> crane = std::nullopt;

  LoaderLimits loader = loader_limits();
  Gateway gateway = {};
};

/// Is nothing ever between the LiDAR and the ship: no rain, fog or dust, nothing on the window?
[[nodiscard]] bool is_clear(const Scenario& scenario);

[[nodiscard]] const std::vector<Scenario>& scenarios();

/// nullptr when there is none of that name.
[[nodiscard]] const Scenario* find_scenario(std::string_view name);

}  // namespace hulltrack
