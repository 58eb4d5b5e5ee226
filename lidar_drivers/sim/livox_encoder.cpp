#include "lidar_drivers/sim/livox_encoder.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/livox/livox_format.hpp"

namespace hulltrack::sim {

namespace {

constexpr std::size_t kShots = 96;
constexpr std::size_t kLasers = 4;
constexpr std::size_t kRecordBytes = 14;
constexpr Nanoseconds kShotPeriod{5'000};
constexpr double kTurnsPerSecond = 10.0 * std::numbers::sqrt2;
constexpr double kNodsPerSecond = 230.0 * std::numbers::inv_sqrtpi;
constexpr double kLowest = -7.0;   // deg
constexpr double kHighest = 52.0;  // deg
constexpr std::uint8_t kPtp = 1;
constexpr std::uint8_t kCartesian = 1;

/// 0 at phase 0, 1 at 0.5, 0 at 1, even in between: every elevation gets its share.
double triangle(double phase) { return 1.0 - std::abs(1.0 - 2.0 * (phase - std::floor(phase))); }

std::uint32_t code(double metres) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(metres * 1e3)));
}

/// Farther than any return, and well inside the format.
constexpr double kFarthest = 1e6;  // m

}  // namespace

Result<LivoxEncoder> LivoxEncoder::create(std::string_view model, const LidarEncoderConfig& config) {
  if (model != "livox_mid360")
    return Error{"no Livox that can be played is called \"" + std::string(model) + "\""};
  if (config.return_mode != ReturnMode::strongest) return Error{"a Livox Mid-360's return mode is strongest"};
  return LivoxEncoder(config);
}

std::size_t LivoxEncoder::firings_per_packet() const { return kShots; }

Nanoseconds LivoxEncoder::packet_interval() const { return static_cast<int>(kShots) * kShotPeriod; }

Nanoseconds LivoxEncoder::packet_duration() const { return static_cast<int>(kShots - 1) * kShotPeriod; }

LaserFiring LivoxEncoder::firing(std::uint64_t packet, std::size_t shot) const {
  const std::size_t laser = shot % kLasers;
  const Nanoseconds time = first_firing(packet) + static_cast<int>(shot) * kShotPeriod;
  const double share = static_cast<double>(laser) / kLasers;
  const double nod = triangle(kNodsPerSecond * to_seconds(time) + share);
  const double elevation = radians(kLowest + (kHighest - kLowest) * nod);
  const double turned = kTurnsPerSecond * to_seconds(time);
  const double azimuth = config_.start_azimuth + 2.0 * std::numbers::pi * (turned - std::floor(turned));
  const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                  -std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  return {time, azimuth, elevation, Eigen::Vector3d::Zero(), direction, static_cast<std::uint8_t>(laser)};
}

void LivoxEncoder::firings(std::uint64_t packet, std::vector<LaserFiring>& out) const {
  out.clear();
  for (std::size_t shot = 0; shot < kShots; ++shot) out.push_back(firing(packet, shot));
}

std::vector<std::uint8_t> LivoxEncoder::encode(std::uint64_t packet,
                                               std::span<const LaserReturn> returns) const {
  assert(returns.size() == kShots);
  const livox::Generation& generation = livox::kGeneration2;
  std::vector<std::uint8_t> bytes(generation.header + kShots * kRecordBytes);
  bytes[0] = generation.version;
  write_le16(bytes, livox::kLengthOffset, static_cast<std::uint16_t>(bytes.size()));
  write_le16(bytes, livox::kIntervalOffset,
             static_cast<std::uint16_t>(packet_duration() / livox::kIntervalUnit));
  write_le16(bytes, livox::kDotsOffset, kShots);
  write_le16(bytes, livox::kCountOffset, static_cast<std::uint16_t>(packet % livox::kCountWrap));
  bytes[generation.type_offset] = kCartesian;
  bytes[generation.stamp_type_offset] = kPtp;
  const auto stamp = static_cast<std::uint64_t>((config_.utc + first_firing(packet)).count());
  write_le32(bytes, generation.stamp_offset, static_cast<std::uint32_t>(stamp));
  write_le32(bytes, generation.stamp_offset + 4, static_cast<std::uint32_t>(stamp >> 32));
  for (std::size_t shot = 0; shot < kShots; ++shot) {
    const LaserReturn& hit = returns[shot];
    if (!(hit.range > 0.0 && hit.range <= kFarthest)) continue;
    const Eigen::Vector3d point = hit.range * firing(packet, shot).direction;
    const std::size_t at = generation.header + shot * kRecordBytes;
    for (std::size_t axis = 0; axis < 3; ++axis)
      write_le32(bytes, at + 4 * axis, code(point[static_cast<Eigen::Index>(axis)]));
    bytes[at + 12] = hit.intensity;
  }
  return bytes;
}

}  // namespace hulltrack::sim
