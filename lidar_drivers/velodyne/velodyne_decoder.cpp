#include "lidar_drivers/velodyne/velodyne_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/rotor.hpp"

namespace hulltrack::velodyne {

namespace {

/// A direction in the plane.
struct Heading {
  double cos, sin;

  /// Turned on by a small angle, rad. Below 0.03 (the rotor's way during a block, at most) the series are
  /// true to 3e-10, far below a micrometre at any range, at a fifth of the cost of sine and cosine.
  [[nodiscard]] Heading turned(double angle) const {
    const double square = angle * angle;
    const double s = angle * (1.0 - square / 6.0);
    const double c = 1.0 - square * (0.5 - square / 24.0);
    return {cos * c - sin * s, sin * c + cos * s};
  }
};

double centidegrees_to_rad(double value) { return radians(value * 0.01); }

ReturnMode return_mode_of(std::uint8_t code) {
  switch (code) {
    case kModeStrongest:
      return ReturnMode::strongest;
    case kModeLast:
      return ReturnMode::last;
    case kModeDual:
      return ReturnMode::dual;
    default:
      return ReturnMode::unknown;
  }
}

std::uint16_t block_azimuth(Bytes payload, std::size_t block) {
  return read_le16(payload, block * kBlockBytes + 2);
}

std::string product_name(std::uint32_t code) {
  const auto all = models();
  const auto it = std::ranges::find(all, code, &ModelTable::product);
  char text[64];
  std::snprintf(text, sizeof text, "%s (product code 0x%02X)",
                it == all.end() ? "an unknown model" : std::string(it->title).c_str(), code);
  return text;
}

}  // namespace

/// How the rotor moved during one packet. A group is a block, or with dual return a pair of blocks.
struct VelodyneDecoder::Rotation {
  std::size_t groups = 0;
  std::size_t blocks_per_group = 1;
  std::array<int, kBlocks> azimuth{};  // 0.01 deg at the group's first firing
  std::array<int, kBlocks> step{};     // to the next group as reported, 0.01 deg; the last group has none
  std::array<bool, kBlocks> jump{};    // the step does not fit the rotation
  std::array<int, kBlocks> advance{};  // by which azimuth turns within one block period, 0.01 deg
  std::array<Nanoseconds, kBlocks> time{};  // of the group's first firing, after the packet's first
  double rate = 0.0;                        // 0.01 deg a block period
  Nanoseconds duration{};                   // first to last firing

  [[nodiscard]] int median_step() const {
    std::array<int, kBlocks> sorted = step;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((groups - 1) / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(groups - 1));
    return std::max(*middle, 0);
  }
};

VelodyneDecoder::VelodyneDecoder(const ModelTable& model, const DecoderOptions& options)
    : model_(model), options_(options), beams_{} {
  const auto period = static_cast<double>(model.block_period.count());
  for (std::size_t k = 0; k < kSlots; ++k) {
    const Slot& slot = model.slots[k];
    const double elevation = radians(slot.elevation_deg);
    const double azimuth = radians(slot.azimuth_offset_deg);
    beams_[k] = {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                 std::sin(elevation), options.vertical_offset ? slot.vertical_offset_m : 0.0,
                 options.firing_correction ? static_cast<double>(slot.time.count()) / period : 0.0};
  }
}

DecodeOutcome VelodyneDecoder::decode(std::span<const std::uint8_t> payload, DecodedPacket& out) const {
  out.points.clear();
  if (const DecodeOutcome outcome = check(payload); !outcome.ok()) return outcome;
  Rotation rotation;
  if (const DecodeOutcome outcome = read_rotation(payload, rotation); !outcome.ok()) return outcome;

  const std::size_t last = rotation.groups - 1;
  const auto period = static_cast<double>(model_.block_period.count());
  const double last_fraction = static_cast<double>(model_.slots.back().time.count()) / period;
  const double last_azimuth = rotation.azimuth[last] + rotation.advance[last] * last_fraction;
  out.duration = rotation.duration;
  out.interval = rotation.time[last] + model_.block_period;
  out.sensor_time =
      (std::chrono::microseconds(read_le32(payload, kTimestampOffset)) + out.duration) % kClockWrap;
  out.clock_reference = ClockReference::unknown;
  out.first_azimuth = centidegrees_to_rad(rotation.azimuth[0]);
  out.last_azimuth = centidegrees_to_rad(std::fmod(last_azimuth + kCentidegrees, kCentidegrees));
  out.rotation_rate = centidegrees_to_rad(rotation.rate) / to_seconds(model_.block_period);
  out.return_mode = return_mode_of(payload[kReturnModeOffset]);
  out.zero_crossing.reset();
  out.cut_azimuth.reset();
  out.counter.reset();
  for (std::size_t g = 0; g < rotation.groups; ++g) {
    const bool has_next = g < last;
    if (has_next && rotation.jump[g]) out.cut_azimuth = centidegrees_to_rad(rotation.azimuth[g]);
    const int step = has_next ? rotation.step[g] : rotation.advance[g];
    const Nanoseconds span = has_next ? rotation.time[g + 1] - rotation.time[g] : model_.block_period;
    const auto passed = rotor::time_to_zero(rotation.azimuth[g], step, span);
    if (!passed || out.zero_crossing) continue;
    const Nanoseconds crossing = rotation.time[g] + *passed - rotation.duration;
    if (crossing <= Nanoseconds::zero()) out.zero_crossing = crossing;
  }
  for (std::size_t block = 0; block < kBlocks; ++block) emit_block(payload, block, rotation, out);
  return {};
}

DecodeOutcome VelodyneDecoder::check(std::span<const std::uint8_t> payload) const {
  if (payload.size() != kPacketBytes) {
    return {DecodeStatus::wrong_size, kPacketBytes, static_cast<std::uint32_t>(payload.size())};
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::uint16_t flag = read_le16(payload, block * kBlockBytes);
    if (flag != kBlockFlag) return {DecodeStatus::bad_flag, kBlockFlag, flag};
  }
  const std::uint8_t product = payload[kProductOffset];
  if (product != model_.product) return {DecodeStatus::wrong_product, model_.product, product};
  const std::uint8_t mode = payload[kReturnModeOffset];
  if (return_mode_of(mode) == ReturnMode::unknown) return {DecodeStatus::wrong_return_mode, 0, mode};
  return {};
}

DecodeOutcome VelodyneDecoder::read_rotation(std::span<const std::uint8_t> payload, Rotation& r) const {
  r.blocks_per_group = payload[kReturnModeOffset] == kModeDual ? 2 : 1;
  r.groups = kBlocks / r.blocks_per_group;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const int azimuth = block_azimuth(payload, block);
    const std::size_t group = block / r.blocks_per_group;
    const bool second_of_pair = block % r.blocks_per_group == 1;
    if (azimuth >= kCentidegrees || (second_of_pair && azimuth != r.azimuth[group])) {
      return {DecodeStatus::bad_azimuth, 0, static_cast<std::uint32_t>(azimuth)};
    }
    r.azimuth[group] = azimuth;
  }

  int turned = 0;
  for (std::size_t g = 0; g + 1 < r.groups; ++g) {
    r.step[g] = rotor::forward_step(r.azimuth[g], r.azimuth[g + 1]);
    turned += r.step[g];
  }
  const int median = r.median_step();
  const double rpm_per_step = 60.0 / kCentidegrees / to_seconds(model_.block_period);
  if (turned > kCentidegrees || median * rpm_per_step > kMaxRpm) {
    return {DecodeStatus::bad_azimuth, 0, static_cast<std::uint32_t>(std::max(turned, median))};
  }

  r.rate = rotor::fit_steps(std::span(r.step).first(r.groups - 1), median, r.jump).value_or(0.0);

  const bool rate_known = r.rate * rpm_per_step >= rotor::kMinRpmToTimeJumps;
  for (std::size_t g = 0; g < r.groups; ++g) {
    const bool unusable = g + 1 == r.groups || r.jump[g];
    const int before = g > 0 ? r.advance[g - 1] : median;
    r.advance[g] = unusable ? before : r.step[g];
    if (g + 1 == r.groups) break;
    r.time[g + 1] =
        r.time[g] + rotor::duration_of(r.step[g], r.jump[g], r.rate, rate_known, model_.block_period);
  }
  r.duration = r.time[r.groups - 1] + model_.slots.back().time;
  return {};
}

void VelodyneDecoder::emit_block(std::span<const std::uint8_t> payload, std::size_t block,
                                 const Rotation& rotation, DecodedPacket& out) const {
  const std::size_t group = block / rotation.blocks_per_group;
  const bool second_of_pair = block % rotation.blocks_per_group == 1;
  const double azimuth = centidegrees_to_rad(rotation.azimuth[group]);
  const Heading first_firing{std::cos(azimuth), std::sin(azimuth)};
  const double advance = centidegrees_to_rad(rotation.advance[group]);
  const Nanoseconds block_time = rotation.time[group] - rotation.duration;
  const std::size_t slots = block * kBlockBytes + kBlockHeaderBytes;
  for (std::size_t k = 0; k < kSlots; ++k) {
    const std::size_t at = slots + k * kSlotBytes;
    const std::uint16_t raw = read_le16(payload, at);
    if (raw == 0) continue;
    const std::uint16_t first_echo = second_of_pair ? read_le16(payload, at - kBlockBytes) : std::uint16_t{0};
    if (first_echo == raw && !options_.repeated_echoes) continue;

    const Beam& beam = beams_[k];
    const Heading turn = first_firing.turned(advance * beam.fraction_of_period);
    const double range = raw * model_.distance_unit;
    LidarPoint& point = out.points.emplace_back();
    point.x = static_cast<float>(range * (turn.cos * beam.forward + turn.sin * beam.left));
    point.y = static_cast<float>(range * (turn.cos * beam.left - turn.sin * beam.forward));
    point.z = static_cast<float>(range * beam.up + beam.vertical_offset);
    point.dt_ns = static_cast<std::int32_t>((block_time + model_.slots[k].time).count());
    point.intensity = payload[at + 2];
    point.channel = model_.slots[k].channel;
    point.echo = first_echo != 0 ? std::uint8_t{1} : std::uint8_t{0};
  }
}

std::string VelodyneDecoder::explain(const DecodeOutcome& outcome) const {
  char text[96];
  switch (outcome.status) {
    case DecodeStatus::ok:
      return "ok";
    case DecodeStatus::wrong_size:
      std::snprintf(text, sizeof text, "expected datagrams of %u bytes, saw %u bytes", outcome.expected,
                    outcome.seen);
      return text;
    case DecodeStatus::bad_flag:
      std::snprintf(text, sizeof text, "expected block flag 0x%04X, saw 0x%04X", outcome.expected,
                    outcome.seen);
      return text;
    case DecodeStatus::wrong_product:
      return "expected " + product_name(outcome.expected) + ", saw " + product_name(outcome.seen);
    case DecodeStatus::wrong_return_mode:
      std::snprintf(text, sizeof text, "expected return mode 0x37, 0x38 or 0x39, saw 0x%02X", outcome.seen);
      return text;
    case DecodeStatus::bad_azimuth:
      std::snprintf(text, sizeof text, "expected the azimuths of a turning sensor, saw %.2f deg",
                    outcome.seen * 0.01);
      return text;
    default:  // other vendors'
      break;
  }
  return "unknown";
}

}  // namespace hulltrack::velodyne
