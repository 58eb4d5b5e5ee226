#include "daemon/app/prepare.hpp"

#include <exception>
#include <string>
#include <utility>

#include "core/io/map_file.hpp"
#include "daemon/config/read_config.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack {
namespace {

Preparation prepare_or_throw(const std::filesystem::path& config_file) {
  ConfigReading reading = read_config(config_file, lidar_model_names());
  if (!reading.config) {
    return {std::nullopt, std::move(reading.problems)};
  }
  Preparation preparation;
  const Config& config = *reading.config;
  if (const auto builder = ScanBuilder::create(config.lidars, config.framing); !builder) {
    preparation.problems.push_back({config_file.string(), 0, builder.error().message});
  }
  Result<MapFile> map = read_map_file(config.map_file);
  if (!map) {
    preparation.problems.push_back({config_file.string(), 0, "hull.map: " + map.error().message});
  }
  if (preparation.problems.empty()) {
    const std::size_t dropped = map->dropped;
    preparation.prepared =
        Prepared{*std::move(reading.config), std::make_shared<const HullMap>(std::move(map->cloud)), dropped};
  }
  return preparation;
}

}  // namespace

std::vector<std::string> lidar_model_names() {
  std::vector<std::string> names;
  for (const LidarModel& model : lidar_models()) {
    names.emplace_back(model.name);
  }
  return names;
}

Preparation prepare(const std::filesystem::path& config_file) {
  try {
    return prepare_or_throw(config_file);
  } catch (const std::exception& error) {  // out of memory, at worst
    return {std::nullopt, {{config_file.string(), 0, std::string("cannot be made ready: ") + error.what()}}};
  }
}

}  // namespace hulltrack
