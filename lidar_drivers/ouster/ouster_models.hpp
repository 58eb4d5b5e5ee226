// Ouster's rows of the model registry.
#pragma once

#include <vector>

#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack::ouster {

[[nodiscard]] std::vector<LidarModel> lidar_models();

}  // namespace hulltrack::ouster
