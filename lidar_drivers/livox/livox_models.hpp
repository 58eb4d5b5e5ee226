// Livox's rows of the model registry.
#pragma once

#include <vector>

#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack::livox {

[[nodiscard]] std::vector<LidarModel> lidar_models();

}  // namespace hulltrack::livox
