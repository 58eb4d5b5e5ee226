// Is a map one of a hull, and can a ship be tracked by it as it is configured?
//
// Refused: what gives a pose another meaning than the contract's (the map's unit is not the metre, the
// reference point is far off the ship), a region or an envelope that no pose can lie in, and a map with too
// few points to match or to judge a pose by. Warned of: what can only cost health. A service without health
// does no harm, and a site that is not finished may want to start. Frames: map in H, region in W, envelope
// as displacements; metres. Pure. Cost: judge_cloud() 5 ns a point, judge_map() some milliseconds.
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

/// Judges the points alone, before a HullMap is built of them. `cloud_H`: one point or more, finite.
[[nodiscard]] std::vector<MapFinding> judge_cloud(const Cloud& cloud_H, const TrackerConfig& config);

/// Judges the surfaces of a map. To be called only if judge_cloud() refuses nothing.
[[nodiscard]] std::vector<MapFinding> judge_map(const HullMap& map);

[[nodiscard]] bool is_refused(const std::vector<MapFinding>& findings);

}  // namespace hulltrack
