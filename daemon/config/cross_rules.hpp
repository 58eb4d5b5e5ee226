// Rules between keys: what each value alone does not show to be wrong.
//
// Pure functions of a Config whose single values are legal. The man page lists the same rules.
#pragma once

#include <string>
#include <vector>

#include "daemon/config/config.hpp"

namespace hulltrack {

struct BrokenRule {
  std::vector<std::string> keys;  // concerned, the one to blame first: "plc.read.slew.offset", "lidar.1.port"
  std::string message;            // what is wrong; what is allowed
};

[[nodiscard]] std::vector<BrokenRule> check_cross_rules(const Config& config);

}  // namespace hulltrack
