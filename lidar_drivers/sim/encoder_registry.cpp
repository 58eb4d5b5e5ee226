#include "lidar_drivers/sim/encoder_registry.hpp"

#include <string>
#include <utility>

#include "lidar_drivers/sim/hesai_encoder.hpp"
#include "lidar_drivers/sim/livox_encoder.hpp"
#include "lidar_drivers/sim/ouster_encoder.hpp"
#include "lidar_drivers/sim/robosense_encoder.hpp"
#include "lidar_drivers/sim/velodyne_encoder.hpp"

namespace hulltrack::sim {

namespace {

/// Of every encoder's own create().
template <typename Encoder>
Result<std::unique_ptr<const LidarEncoder>> make(std::string_view model, const LidarEncoderConfig& config) {
  auto encoder = Encoder::create(model, config);
  if (!encoder) return encoder.error();
  return std::unique_ptr<const LidarEncoder>(std::make_unique<Encoder>(std::move(encoder).value()));
}

}  // namespace

Result<std::unique_ptr<const LidarEncoder>> make_lidar_encoder(std::string_view model,
                                                               const LidarEncoderConfig& config) {
  if (model.starts_with("velodyne_")) return make<VelodyneEncoder>(model, config);
  if (model.starts_with("hesai_")) return make<HesaiEncoder>(model, config);
  if (model.starts_with("robosense_")) return make<RobosenseEncoder>(model, config);
  if (model.starts_with("ouster_")) return make<OusterEncoder>(model, config);
  if (model == "livox_mid360") return make<LivoxEncoder>(model, config);
  return Error{"there is no encoder for \"" + std::string(model) + "\""};
}

}  // namespace hulltrack::sim
