#include "daemon/app/prepare.hpp"

#include <exception>
#include <string>
#include <utility>

#include "core/base/text.hpp"
#include "core/io/map_file.hpp"
#include "daemon/app/quay_file.hpp"
#include "daemon/config/read_config.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {
namespace {

/// What is wrong with the calibration file of LiDAR `lidar`, or with there being none; empty if nothing is.
std::string calibration_problem(const LidarConfig& lidar) {
  const LidarModel* model = find_lidar_model(lidar.model);
  if (model == nullptr) {
    return {};  // told already, and nobody knows what it would need
  }
  const auto decoder = make_lidar_decoder(*model, {}, lidar.calibration);
  return decoder ? "" : decoder.error().message;
}

/// Goes on where the configuration has problems, so that a person hears of all of them at once.
Preparation prepare_or_throw(const std::filesystem::path& config_file) {
  ConfigReading reading = read_config(config_file, lidar_models());
  Preparation preparation{std::nullopt, std::move(reading.problems)};
  const Config& config = reading.readable;
  const auto complain = [&](const std::string& key, const std::string& message) {
    preparation.problems.push_back(reading.problem_with(config_file, key, message));
  };
  for (std::size_t i = 0; i < config.lidars.size(); ++i) {
    const std::string key = "lidar." + std::to_string(i) + ".calibration";
    const std::string problem = calibration_problem(config.lidars[i]);
    if (!problem.empty() && !reading.bad_keys.contains(key)) {
      complain(key, problem);
    }
  }
  Result<QuayFile> quay = read_quay_file(config.quay_file);
  if (!quay) {
    complain("quay.map", quay.error().message);
  }
  if (!config.map_file.empty()) {
    Result<MapFile> map = read_map_file(config.map_file);
    if (!map) {
      complain("hull.map", map.error().message);
    } else if (const auto least = static_cast<std::size_t>(config.tracker.health.min_matched);
               map->cloud.size() < least) {
      complain("hull.map", config.map_file.string() + ": has " + counted(map->cloud.size(), "point") +
                               ", fewer than health.min_matched = " + std::to_string(least) +
                               "; no scan could ever match it: make a denser map");
    } else if (reading.config && preparation.problems.empty()) {
      std::string remark = remark_on_dropped(config.map_file, *map);
      if (!quay->remark.empty()) {
        remark += (remark.empty() ? "" : "\n") + quay->remark;
      }
      preparation.prepared =
          Prepared{*std::move(reading.config), std::make_shared<const HullMap>(std::move(map->cloud)),
                   quay->map, std::move(remark)};
    }
  }
  sort_by_line(preparation.problems);
  return preparation;
}

}  // namespace

Preparation prepare(const std::filesystem::path& config_file) {
  try {
    return prepare_or_throw(config_file);
  } catch (const std::exception& error) {  // out of memory, at worst
    return {std::nullopt, {{config_file.string(), 0, std::string("cannot be made ready: ") + error.what()}}};
  }
}

}  // namespace hulltrack
