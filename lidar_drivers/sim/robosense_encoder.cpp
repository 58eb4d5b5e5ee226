#include "lidar_drivers/sim/robosense_encoder.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <string>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/sim/rotating.hpp"

namespace hulltrack::sim {

namespace {

using robosense::Family;

constexpr std::uint8_t kPtp = 2;  // the clock's state in a DIFOP packet

std::uint8_t mode_code(ReturnMode mode, Family family) {
  if (mode == ReturnMode::dual) return 0;
  if (family == Family::helios) return mode == ReturnMode::last ? 5 : 4;
  return mode == ReturnMode::last ? 2 : 1;
}

void write_clock(std::span<std::uint8_t> clock, Nanoseconds time, Family family) {
  using namespace std::chrono;
  const auto second = floor<seconds>(time);
  const auto micros = floor<microseconds>(time - second).count();
  if (family == Family::helios) {
    const auto count = static_cast<std::uint64_t>(second.count());
    write_be16(clock, 0, static_cast<std::uint16_t>(count >> 32));
    write_be32(clock, 2, static_cast<std::uint32_t>(count));
    write_be32(clock, 6, static_cast<std::uint32_t>(micros));
    return;
  }
  const sys_seconds moment(second);
  const sys_days day = floor<days>(moment);
  const year_month_day date(day);
  const hh_mm_ss clock_time(moment - day);
  clock[0] = static_cast<std::uint8_t>(static_cast<int>(date.year()) - 2000);
  clock[1] = static_cast<std::uint8_t>(static_cast<unsigned>(date.month()));
  clock[2] = static_cast<std::uint8_t>(static_cast<unsigned>(date.day()));
  clock[3] = static_cast<std::uint8_t>(clock_time.hours().count());
  clock[4] = static_cast<std::uint8_t>(clock_time.minutes().count());
  clock[5] = static_cast<std::uint8_t>(clock_time.seconds().count());
  write_be16(clock, 6, static_cast<std::uint16_t>(micros / 1000));
  write_be16(clock, 8, static_cast<std::uint16_t>(micros % 1000));
}

void write_angle(std::span<std::uint8_t> bytes, std::size_t at, double angle_deg) {
  bytes[at] = angle_deg < 0.0 ? 1 : 0;
  write_be16(bytes, at + 1, static_cast<std::uint16_t>(std::lround(std::abs(angle_deg) * 100.0)));
}

}  // namespace

Result<RobosenseEncoder> RobosenseEncoder::create(std::string_view model, const LidarEncoderConfig& config) {
  const robosense::ModelTable* table = robosense::find_model(model);
  if (table == nullptr) return Error{"no RoboSense model is called \"" + std::string(model) + "\""};
  if (!std::ranges::is_sorted(table->pulse.begin(), table->pulse.begin() + static_cast<long>(table->lasers)))
    return Error{"there is no encoder for " + std::string(model) + ": its wire order is not that of firing"};
  if (auto problem = settings_problem("RoboSense", robosense::kMaxRpm, config)) return *problem;
  return RobosenseEncoder(*table, config);
}

RobosenseEncoder::RobosenseEncoder(const robosense::ModelTable& model, const LidarEncoderConfig& config)
    : model_(&model), config_(config) {
  for (std::size_t k = 0; k < model.lasers; ++k) {
    const auto n = static_cast<double>(k);
    if (model.family == Family::classic) {  // the RS16: 0-7 below the horizon, 8-15 above
      angles_[k] = {k < 8 ? -15.0 + 2.0 * n : 15.0 - 2.0 * (n - 8.0), 0.0};
    } else {
      angles_[k] = {model.lasers == 16 ? 15.0 - 2.0 * n : 15.0 - 2.25 * n, k % 2 == 0 ? -4.0 : 3.6};
    }
  }
}

int RobosenseEncoder::blocks_per_firing() const { return dual() && model_->lasers == 32 ? 2 : 1; }

int RobosenseEncoder::firings_per_block() const { return !dual() && model_->lasers == 16 ? 2 : 1; }

std::size_t RobosenseEncoder::firings_per_packet() const {
  return robosense::kBlocks * robosense::kSlots / (dual() ? 2 : 1);
}

Nanoseconds RobosenseEncoder::packet_interval() const {
  return static_cast<int>(firings_per_packet() / model_->lasers) * model_->period;
}

Nanoseconds RobosenseEncoder::packet_duration() const {
  return packet_interval() - model_->period + model_->pulse[model_->lasers - 1];
}

void RobosenseEncoder::firings(std::uint64_t packet, std::vector<LaserFiring>& out) const {
  out.clear();
  for (std::size_t i = 0; i < firings_per_packet(); ++i) {
    const std::size_t laser = i % model_->lasers;
    const Nanoseconds time =
        first_firing(packet) + static_cast<int>(i / model_->lasers) * model_->period + model_->pulse[laser];
    const double rotor = radians(rotor_azimuth(config_, time));
    const double azimuth = rotor + radians(angles_[laser].azimuth_deg);
    const double elevation = radians(angles_[laser].elevation_deg);
    const Eigen::Vector3d direction = direction_of(azimuth, elevation);
    const Eigen::Vector3d lens(model_->lens_forward * std::cos(rotor),
                               -model_->lens_forward * std::sin(rotor), model_->lens_up);
    out.push_back({time, azimuth, elevation, lens, direction, static_cast<std::uint8_t>(laser)});
  }
}

std::vector<std::uint8_t> RobosenseEncoder::encode(std::uint64_t packet,
                                                   std::span<const LaserReturn> returns) const {
  assert(returns.size() == firings_per_packet() * (dual() ? 2 : 1));
  std::vector<std::uint8_t> bytes(robosense::kPacketBytes);
  const bool classic = model_->family == Family::classic;
  write_be32(bytes, 0, classic ? robosense::kClassicId : robosense::kHeliosId);
  if (classic) write_be32(bytes, 4, robosense::kClassicIdRest);
  if (model_->tells_state) write_be32(bytes, robosense::kCountOffset, static_cast<std::uint32_t>(packet));
  write_clock(std::span(bytes).subspan(robosense::kClockOffset, 10), config_.utc + first_firing(packet),
              model_->family);
  for (std::size_t block = 0; block < robosense::kBlocks; ++block) {
    const int first = static_cast<int>(block) / blocks_per_firing() * firings_per_block();
    const double turned = rotor_azimuth(config_, first_firing(packet) + first * model_->period);
    const auto azimuth = static_cast<int>(std::lround(turned * 100.0)) % robosense::kCentidegrees;
    const std::size_t base = robosense::kHeaderBytes + block * robosense::kBlockBytes;
    write_be16(bytes, base, robosense::kBlockFlag);
    write_be16(bytes, base + 2, static_cast<std::uint16_t>(azimuth));
    for (std::size_t slot = 0; slot < robosense::kSlots; ++slot) {
      const std::size_t firing =
          static_cast<std::size_t>(first) * model_->lasers + (dual() ? slot % model_->lasers : slot);
      const std::size_t echo = model_->lasers == 32 ? block % 2 : slot / 16;
      const LaserReturn& hit = dual() ? returns[2 * firing + echo] : returns[firing];
      const std::size_t at = base + robosense::kBlockHeaderBytes + slot * robosense::kSlotBytes;
      const std::uint16_t distance = distance_code(hit.range, model_->distance_unit);
      write_be16(bytes, at, distance);
      bytes[at + 2] = distance == 0 ? std::uint8_t{0} : hit.intensity;
    }
  }
  write_be16(bytes, robosense::kPacketBytes - 2, 0x00FF);
  return bytes;
}

SensorInformation RobosenseEncoder::information() const {
  std::vector<std::uint8_t> bytes(robosense::kPacketBytes);
  std::ranges::copy(robosense::kDifopId, bytes.begin());
  write_be16(bytes, robosense::kDifopRpmOffset, static_cast<std::uint16_t>(std::lround(config_.rpm)));
  bytes[robosense::kDifopReturnModeOffset] = mode_code(config_.return_mode, model_->family);
  if (model_->tells_state) bytes[robosense::kDifopClockOffset] = kPtp;
  if (model_->family == Family::classic) {
    for (std::size_t k = 0; k < model_->lasers; ++k) {
      const std::size_t at = robosense::kDifopRs16VerticalOffset + k * robosense::kAngleBytes;
      const auto size = static_cast<std::uint32_t>(std::lround(std::abs(angles_[k].elevation_deg) * 1e4));
      bytes[at] = static_cast<std::uint8_t>(size >> 16);
      write_be16(bytes, at + 1, static_cast<std::uint16_t>(size));
    }
  } else {
    for (std::size_t k = 0; k < robosense::kSlots; ++k) {
      const std::size_t vertical = robosense::kDifopVerticalOffset + k * robosense::kAngleBytes;
      const std::size_t horizontal = robosense::kDifopHorizontalOffset + k * robosense::kAngleBytes;
      if (k >= model_->lasers) {
        bytes[vertical] = bytes[horizontal] = 0xFF;  // not calibrated
        continue;
      }
      write_angle(bytes, vertical, angles_[k].elevation_deg);
      write_angle(bytes, horizontal, angles_[k].azimuth_deg);
    }
  }
  return {"difop.bin", std::string(bytes.begin(), bytes.end()), bytes};
}

}  // namespace hulltrack::sim
