// `hulltrack models`: every LiDAR model with its defaults.
#include <cstdio>
#include <string>

#include "core/base/text.hpp"
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

/// A line of the table; 120 columns hold it.
void line(const std::string& model, const std::string& maker, const std::string& name,
          const std::string& lasers, const std::string& port, const std::string& information,
          const std::string& range, const std::string& time, const std::string& clock,
          const std::string& calibration) {
  std::printf("%-19s %-9s %-13s %6s %5s %5s %5s  %-7s  %-8s  %s\n", model.c_str(), maker.c_str(),
              name.c_str(), lasers.c_str(), port.c_str(), information.c_str(), range.c_str(), time.c_str(),
              clock.c_str(), calibration.c_str());
}

void list_models() {
  line("model", "maker", "name", "lasers", "port", "info", "range", "time", "clock by", "calibration file");
  for (const LidarModel& model : lidar_models()) {
    line(std::string(model.name), std::string(model.vendor), std::string(model.title),
         std::to_string(model.channels), std::to_string(model.port),
         model.information_port == 0 ? "-" : std::to_string(model.information_port),
         format_text("%.0f m", model.range), model.time_source == TimeSource::receive ? "receive" : "sensor",
         std::string(model.clock_by), calibration_words(model));
  }
  std::printf(
      "\n"
      "port, info   UDP ports from the factory: points, and what the sensor tells about itself\n"
      "time         recommended time_source: \"receive\" needs no synchronisation and is as good as 0.1 mm "
      "at the\n"
      "             boom's tip on a quiet network; \"sensor\" needs the sensor's clock set by what `clock "
      "by` names\n");
}

}  // namespace

void add_models(CLI::App& app) {
  CLI::App* command = app.add_subcommand("models", "Every LiDAR model with its defaults.");
  command->footer("The first column is what `model` of a [[lidar]] section and --model take.");
  command->callback(list_models);
}

}  // namespace hulltrack
