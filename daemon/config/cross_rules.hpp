// Rules between keys: what each value alone does not show to be wrong.
//
// Pure functions of a Config whose single values are legal. The man page lists the same rules.
#pragma once

#include <span>
#include <vector>

#include "core/base/broken_rule.hpp"
#include "daemon/config/config.hpp"
#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack {

/// `models`: those of this build; a LiDAR of another one is judged without.
[[nodiscard]] std::vector<BrokenRule> check_cross_rules(const Config& config,
                                                        std::span<const LidarModel> models);

}  // namespace hulltrack
