// Rules between keys: what each value alone does not show to be wrong.
//
// Pure functions of a Config whose single values are legal. The man page lists the same rules.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "daemon/config/config.hpp"
#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack {

struct BrokenRule {
  std::vector<std::string> keys;  // concerned, the one to blame first: "plc.read.slew.offset", "lidar.1.port"
  std::string message;            // what is wrong; what is allowed
};

/// `models`: those of this build; a LiDAR of another one is judged without.
[[nodiscard]] std::vector<BrokenRule> check_cross_rules(const Config& config,
                                                        std::span<const LidarModel> models);

}  // namespace hulltrack
