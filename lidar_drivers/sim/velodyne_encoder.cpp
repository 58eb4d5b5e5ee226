#include "lidar_drivers/sim/velodyne_encoder.hpp"

#include <cassert>
#include <cmath>
#include <string>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/sim/rotating.hpp"

namespace hulltrack::sim {

namespace {

std::uint8_t mode_code(ReturnMode mode) {
  switch (mode) {
    case ReturnMode::last:
      return velodyne::kModeLast;
    case ReturnMode::dual:
      return velodyne::kModeDual;
    default:
      break;
  }
  return velodyne::kModeStrongest;
}

}  // namespace

Result<VelodyneEncoder> VelodyneEncoder::create(std::string_view model, const LidarEncoderConfig& config) {
  const velodyne::ModelTable* table = velodyne::find_model(model);
  if (table == nullptr) return Error{"no Velodyne model is called \"" + std::string(model) + "\""};
  if (auto problem = settings_problem("Velodyne", velodyne::kMaxRpm, config)) return *problem;
  return VelodyneEncoder(*table, config);
}

VelodyneEncoder::VelodyneEncoder(const velodyne::ModelTable& model, const LidarEncoderConfig& config)
    : model_(&model), config_(config) {}

int VelodyneEncoder::groups() const {
  return static_cast<int>(config_.return_mode == ReturnMode::dual ? velodyne::kBlocks / 2
                                                                  : velodyne::kBlocks);
}

std::size_t VelodyneEncoder::firings_per_packet() const {
  return static_cast<std::size_t>(groups()) * velodyne::kSlots;
}

Nanoseconds VelodyneEncoder::packet_interval() const { return groups() * model_->block_period; }

Nanoseconds VelodyneEncoder::packet_duration() const {
  return (groups() - 1) * model_->block_period + model_->slots.back().time;
}

void VelodyneEncoder::firings(std::uint64_t packet, std::vector<LaserFiring>& out) const {
  out.clear();
  for (int group = 0; group < groups(); ++group) {
    const Nanoseconds block = first_firing(packet) + group * model_->block_period;
    for (const velodyne::Slot& slot : model_->slots) {
      const Nanoseconds time = block + slot.time;
      const double azimuth = radians(rotor_azimuth(config_, time) + slot.azimuth_offset_deg);
      const double elevation = radians(slot.elevation_deg);
      const Eigen::Vector3d direction = direction_of(azimuth, elevation);
      out.push_back({time, azimuth, elevation, {0.0, 0.0, slot.vertical_offset_m}, direction, slot.channel});
    }
  }
}

std::vector<std::uint8_t> VelodyneEncoder::encode(std::uint64_t packet,
                                                  std::span<const LaserReturn> returns) const {
  const bool dual = config_.return_mode == ReturnMode::dual;
  assert(returns.size() == firings_per_packet() * (dual ? 2 : 1));
  std::vector<std::uint8_t> bytes(velodyne::kPacketBytes);
  for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
    const std::size_t group = dual ? block / 2 : block;
    const Nanoseconds time = first_firing(packet) + static_cast<int>(group) * model_->block_period;
    const auto azimuth =
        static_cast<int>(std::lround(rotor_azimuth(config_, time) * 100.0)) % velodyne::kCentidegrees;
    const std::size_t base = block * velodyne::kBlockBytes;
    write_le16(bytes, base, velodyne::kBlockFlag);
    write_le16(bytes, base + 2, static_cast<std::uint16_t>(azimuth));
    for (std::size_t slot = 0; slot < velodyne::kSlots; ++slot) {
      const std::size_t firing = group * velodyne::kSlots + slot;
      const LaserReturn& hit = dual ? returns[2 * firing + block % 2] : returns[firing];
      const std::size_t at = base + velodyne::kBlockHeaderBytes + slot * velodyne::kSlotBytes;
      const std::uint16_t distance = distance_code(hit.range, model_->distance_unit);
      write_le16(bytes, at, distance);
      bytes[at + 2] = distance == 0 ? std::uint8_t{0} : hit.intensity;
    }
  }
  const Nanoseconds clock = (config_.utc + first_firing(packet)) % velodyne::kClockWrap;
  write_le32(bytes, velodyne::kTimestampOffset, static_cast<std::uint32_t>(clock.count() / 1000));
  bytes[velodyne::kReturnModeOffset] = mode_code(config_.return_mode);
  bytes[velodyne::kProductOffset] = model_->product;
  return bytes;
}

}  // namespace hulltrack::sim
