// `hulltrack models`: every LiDAR model with its defaults.
#include <cstdio>
#include <string>

#include "daemon/tools/tools.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {
namespace {

std::string calibration_words(const LidarModel& model) {
  const std::string file(model.calibration_file);
  switch (model.calibration) {
    case LidarModel::Calibration::required:
      return file;
    case LidarModel::Calibration::optional:
      return file + " (optional)";
    case LidarModel::Calibration::none:
      break;
  }
  return "none";
}

void list_models() {
  std::printf("%-20s %-10s %-12s %8s %6s %8s  %s\n", "model", "maker", "name", "channels", "port", "range/m",
              "calibration file");
  for (const LidarModel& model : lidar_models()) {
    std::printf("%-20s %-10s %-12s %8d %6u %8.0f  %s\n", std::string(model.name).c_str(),
                std::string(model.vendor).c_str(), std::string(model.title).c_str(), model.channels,
                unsigned{model.port}, model.range, calibration_words(model).c_str());
  }
}

}  // namespace

void add_models(CLI::App& app) {
  CLI::App* command = app.add_subcommand("models", "Every LiDAR model with its defaults.");
  command->footer("The first column is what `model` of a [[lidar]] section and --model take.");
  command->callback(list_models);
}

}  // namespace hulltrack
