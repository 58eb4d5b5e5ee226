// RoboSense's rows of the model registry.
#pragma once

#include <vector>

#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack::robosense {

[[nodiscard]] std::vector<LidarModel> lidar_models();

}  // namespace hulltrack::robosense
