#include "lidar_drivers/model_registry.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "lidar_drivers/hesai/hesai_models.hpp"
#include "lidar_drivers/livox/livox_models.hpp"
#include "lidar_drivers/ouster/ouster_models.hpp"
#include "lidar_drivers/robosense/robosense_models.hpp"
#include "lidar_drivers/velodyne/velodyne_models.hpp"

namespace hulltrack {

namespace {

/// One line a vendor.
std::vector<LidarModel> all_models() {
  std::vector<LidarModel> all;
  const auto add = [&](const std::vector<LidarModel>& rows) {
    all.insert(all.end(), rows.begin(), rows.end());
  };
  add(velodyne::lidar_models());
  add(ouster::lidar_models());
  add(hesai::lidar_models());
  add(robosense::lidar_models());
  add(livox::lidar_models());
  return all;
}

}  // namespace

std::span<const LidarModel> lidar_models() {
  static const std::vector<LidarModel> kModels = all_models();
  return kModels;
}

const LidarModel* find_lidar_model(std::string_view name) {
  const auto models = lidar_models();
  const auto it = std::ranges::find(models, name, &LidarModel::name);
  return it == models.end() ? nullptr : &*it;
}

Result<std::unique_ptr<Decoder>> make_lidar_decoder(const LidarModel& model, const DecoderOptions& options,
                                                    const std::filesystem::path& calibration) {
  using Calibration = LidarModel::Calibration;
  if (model.calibration == Calibration::none && !calibration.empty())
    return Error{std::string(model.name) + " takes no calibration file; leave it out"};
  if (model.calibration == Calibration::required && calibration.empty())
    return Error{std::string(model.name) +
                 " needs a calibration file: " + std::string(model.calibration_file)};
  return model.make_decoder(options, calibration);
}

}  // namespace hulltrack
