#include "lidar_drivers/sim/hesai_encoder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/hesai/hesai_clock.hpp"
#include "lidar_drivers/sim/rotating.hpp"

namespace hulltrack::sim {

namespace {

constexpr std::uint8_t kProtocolMinor = 1;

std::uint8_t mode_code(ReturnMode mode) {
  switch (mode) {
    case ReturnMode::last:
      return hesai::kModeLast;
    case ReturnMode::dual:
      return hesai::kModeLastStrongest;
    default:
      break;
  }
  return hesai::kModeStrongest;
}

/// Of the lasers in wire order the first has to fire first and the last last.
bool fires_in_wire_order(const hesai::ModelTable& model) {
  return model.firing[0] == model.first_pulse() && model.firing[model.lasers - 1] == model.last_pulse();
}

}  // namespace

Result<HesaiEncoder> HesaiEncoder::create(std::string_view model, const LidarEncoderConfig& config) {
  const hesai::ModelTable* table = hesai::find_model(model);
  if (table == nullptr) return Error{"no Hesai model is called \"" + std::string(model) + "\""};
  if (!fires_in_wire_order(*table)) return Error{"there is no encoder for \"" + std::string(model) + "\""};
  if (auto problem = settings_problem("Hesai", hesai::kMaxRpm, config)) return *problem;
  return HesaiEncoder(*table, config);
}

HesaiEncoder::HesaiEncoder(const hesai::ModelTable& model, const LidarEncoderConfig& config)
    : model_(&model), config_(config) {}

std::size_t HesaiEncoder::returns() const { return config_.return_mode == ReturnMode::dual ? 2 : 1; }

std::size_t HesaiEncoder::groups() const { return model_->blocks / returns(); }

std::size_t HesaiEncoder::firings_per_packet() const { return groups() * model_->lasers; }

Nanoseconds HesaiEncoder::packet_interval() const {
  return static_cast<int>(groups()) * model_->block_period;
}

Nanoseconds HesaiEncoder::packet_duration() const {
  return packet_interval() - model_->block_period + model_->last_pulse() - model_->first_pulse();
}

Nanoseconds HesaiEncoder::reference(std::uint64_t packet, std::size_t group) const {
  return first_firing(packet) + static_cast<int>(group) * model_->block_period - model_->first_pulse();
}

void HesaiEncoder::firings(std::uint64_t packet, std::vector<LaserFiring>& out) const {
  out.clear();
  for (std::size_t group = 0; group < groups(); ++group) {
    for (std::size_t k = 0; k < model_->lasers; ++k) {
      const Nanoseconds time = reference(packet, group) + model_->firing[k];
      const double azimuth = radians(rotor_azimuth(config_, time) + model_->nominal[k].azimuth_deg);
      const double elevation = radians(model_->nominal[k].elevation_deg);
      const Eigen::Vector3d direction = direction_of(azimuth, elevation);
      out.push_back(
          {time, azimuth, elevation, Eigen::Vector3d::Zero(), direction, static_cast<std::uint8_t>(k)});
    }
  }
}

std::vector<std::uint8_t> HesaiEncoder::encode(std::uint64_t packet,
                                               std::span<const LaserReturn> returns) const {
  const std::size_t echoes = this->returns();
  assert(returns.size() == firings_per_packet() * echoes);
  std::vector<std::uint8_t> bytes(model_->bytes() + hesai::kSequenceBytes);
  write_header(bytes);
  for (std::size_t block = 0; block < model_->blocks; ++block) {
    const std::size_t group = block / echoes;
    const double azimuth = rotor_azimuth(config_, reference(packet, group));
    const auto code = static_cast<int>(std::lround(azimuth * 100.0)) % hesai::kCentidegrees;
    write_le16(bytes, model_->azimuth_offset(block), static_cast<std::uint16_t>(code));
    for (std::size_t k = 0; k < model_->lasers; ++k) {
      const LaserReturn& hit = returns[(group * model_->lasers + k) * echoes + block % echoes];
      const std::size_t at = model_->return_offset(block, k);
      const std::uint16_t distance = distance_code(hit.range, model_->distance_unit_mm * 0.001);
      write_le16(bytes, at, distance);
      bytes[at + 2] = distance == 0 ? std::uint8_t{0} : hit.intensity;
    }
  }
  write_tail(bytes, packet);
  return bytes;
}

void HesaiEncoder::write_header(std::span<std::uint8_t> bytes) const {
  const hesai::HeaderLayout& header = model_->header;
  write_le16(bytes, 0, hesai::kHeaderFlag);
  bytes[header.protocol] = model_->protocol;
  bytes[header.protocol + 1] = kProtocolMinor;
  bytes[header.lasers] = static_cast<std::uint8_t>(model_->lasers);
  bytes[header.blocks] = static_cast<std::uint8_t>(model_->blocks);
  bytes[header.distance_unit] = model_->distance_unit_mm;
  bytes[header.distance_unit + 1] = static_cast<std::uint8_t>(model_->max_returns);
  bytes[header.flags] = hesai::kSequenceBit;
}

void HesaiEncoder::write_tail(std::span<std::uint8_t> bytes, std::uint64_t packet) const {
  const hesai::TailLayout& tail = model_->tail;
  const std::size_t base = model_->tail_offset();
  const std::size_t timed_group = model_->time_is_first_blocks ? 0 : groups() - 1;
  bytes[base + tail.return_mode] = mode_code(config_.return_mode);
  write_le16(bytes, base + tail.motor_speed, static_cast<std::uint16_t>(std::lround(config_.rpm)));
  hesai::write_clock(bytes, *model_, config_.utc + reference(packet, timed_group) - model_->block_time);
  write_le32(bytes, model_->bytes(), static_cast<std::uint32_t>(packet));
}

}  // namespace hulltrack::sim
