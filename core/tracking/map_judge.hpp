// Is a map one of a hull, and can a ship be tracked by it as it is configured?
//
// Refused is what gives a pose another meaning than the contract's (a unit that is not the metre, a reference
// point off the ship) and what contradicts itself (a region or an envelope that no pose can lie in). What can
// only cost health is warned of: no pose is fine, and an unfinished site may want to start all the same.
// Frames: map in H, region in W, envelope as displacements; metres. Pure. Cost: judge_cloud() 5 ns a point,
// judge_map() some milliseconds.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/map/hull_map.hpp"
#include "core/tracking/tracker_config.hpp"

namespace hulltrack {

struct MapFinding {
  bool refused;         // false: a warning
  std::string key;      // of the configuration that is to blame: "hull.map", "hull.region", ...
  std::string message;  // what is wrong, with figures; what to do
};

/// What the points themselves tell, before anything is built of them. `cloud_H`: one point or more, finite.
[[nodiscard]] std::vector<MapFinding> judge_cloud(const Cloud& cloud_H, const TrackerConfig& config);

/// What the surfaces of a map tell that judge_cloud() does not refuse.
[[nodiscard]] std::vector<MapFinding> judge_map(const HullMap& map);

[[nodiscard]] bool is_refused(const std::vector<MapFinding>& findings);

}  // namespace hulltrack
