// Which LiDAR models there are: the one list that the configuration, the tools and the builder read.
//
// A new vendor adds a folder with its decoder and a line in model_registry.cpp; nothing else changes.
// Thread rule: immutable.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "core/base/result.hpp"
#include "lidar_drivers/lidar_model.hpp"

namespace hulltrack {

/// Every model, in the order in which `hulltrack models` lists them.
[[nodiscard]] std::span<const LidarModel> lidar_models();

/// nullptr when there is none of that name.
[[nodiscard]] const LidarModel* find_lidar_model(std::string_view name);

/// An error says that a calibration file is unusable, missing, or given to a model that takes none.
[[nodiscard]] Result<std::unique_ptr<Decoder>> make_lidar_decoder(const LidarModel& model,
                                                                  const DecoderOptions& options,
                                                                  const std::filesystem::path& calibration);

}  // namespace hulltrack
