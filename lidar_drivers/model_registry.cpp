#include "lidar_drivers/model_registry.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "lidar_drivers/velodyne/velodyne_decoder.hpp"

namespace hulltrack {

namespace {

constexpr std::uint16_t kVelodynePort = 2368;

/// One factory a model, since a plain function cannot carry the table.
template <std::size_t kIndex>
Result<std::unique_ptr<Decoder>> make_velodyne(const DecoderOptions& options, const std::filesystem::path&) {
  return std::unique_ptr<Decoder>(
      std::make_unique<velodyne::VelodyneDecoder>(velodyne::models()[kIndex], options));
}

template <std::size_t kIndex>
LidarModel velodyne_model() {
  const velodyne::ModelTable& table = velodyne::models()[kIndex];
  return {table.name,  "Velodyne",     table.title, kVelodynePort,
          table.range, table.channels, false,       &make_velodyne<kIndex>};
}

}  // namespace

std::span<const LidarModel> lidar_models() {
  static const std::array kModels = {velodyne_model<0>(), velodyne_model<1>(), velodyne_model<2>(),
                                     velodyne_model<3>()};
  return kModels;
}

const LidarModel* find_lidar_model(std::string_view name) {
  const auto models = lidar_models();
  const auto it = std::ranges::find(models, name, &LidarModel::name);
  return it == models.end() ? nullptr : &*it;
}

Result<std::unique_ptr<Decoder>> make_lidar_decoder(const LidarModel& model, const DecoderOptions& options,
                                                    const std::filesystem::path& calibration) {
  if (!model.needs_calibration && !calibration.empty())
    return Error{std::string(model.name) + " takes no calibration file; leave it out"};
  return model.make_decoder(options, calibration);
}

}  // namespace hulltrack
