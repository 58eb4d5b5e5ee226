// Which LiDAR models can be imitated. Names are those of the model registry.
#pragma once

#include <memory>
#include <string_view>

#include "core/base/result.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack::sim {

/// An error says that there is no encoder for the model, or that it cannot be set so.
[[nodiscard]] Result<std::unique_ptr<const LidarEncoder>> make_lidar_encoder(
    std::string_view model, const LidarEncoderConfig& config);

}  // namespace hulltrack::sim
