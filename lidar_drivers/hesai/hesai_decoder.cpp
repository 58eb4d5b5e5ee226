#include "lidar_drivers/hesai/hesai_decoder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/hesai/hesai_clock.hpp"

namespace hulltrack::hesai {

namespace {

constexpr PacketCounter kCounterWrap{0, std::uint64_t{1} << 32};

ReturnMode return_mode_of(std::uint8_t code) {
  switch (code) {
    case kModeFirst:
      return ReturnMode::first;
    case kModeStrongest:
      return ReturnMode::strongest;
    case kModeLast:
      return ReturnMode::last;
    case kModeTriple:
      return ReturnMode::triple;
    default:
      return ReturnMode::dual;
  }
}

/// A header's statements in one figure, and back.
std::uint32_t packed(std::uint32_t protocol, std::uint32_t lasers, std::uint32_t blocks, std::uint32_t unit) {
  return protocol << 24U | (lasers & 0xFFU) << 16U | (blocks & 0xFFU) << 8U | unit;
}

std::string layout_name(std::uint32_t layout) {
  char text[64];
  std::snprintf(text, sizeof text, "protocol %u, %u lasers, %u blocks, %u mm", layout >> 24U,
                layout >> 16U & 0xFFU, layout >> 8U & 0xFFU, layout & 0xFFU);
  return text;
}

}  // namespace

HesaiDecoder::HesaiDecoder(const ModelTable& model, std::span<const LaserAngles> angles,
                           const DecoderOptions& options)
    : model_(model),
      options_(options),
      angles_{},
      first_pulse_(model.first_pulse()),
      last_pulse_(model.last_pulse()) {
  assert(angles.size() == model.lasers);
  std::ranges::copy(angles.first(std::min(angles.size(), angles_.size())), angles_.begin());
}

DecodeOutcome HesaiDecoder::decode(std::span<const std::uint8_t> payload, DecodedPacket& out) const {
  out.points.clear();
  if (const DecodeOutcome outcome = check(payload); !outcome.ok()) return outcome;
  Datagram datagram{payload, returns(payload), distance_unit(payload), {}, {}};
  if (const DecodeOutcome outcome = read_azimuths(datagram); !outcome.ok()) return outcome;

  const Rotation& rotation = datagram.rotation;
  const std::size_t last = rotation.groups - 1;
  datagram.last_firing = rotation.time[last] + last_pulse_;
  const Nanoseconds timed_block = model_.time_is_first_blocks ? Nanoseconds::zero() : rotation.time[last];
  out.duration = datagram.last_firing - first_pulse_;
  out.interval = rotation.time[last] + model_.block_period;
  out.sensor_time = read_clock(payload, model_) + model_.block_time + datagram.last_firing - timed_block;
  out.clock_reference = ClockReference::unknown;
  out.first_azimuth = rotation.azimuth_at(0, first_pulse_);
  out.last_azimuth = rotation.azimuth_at(last, last_pulse_);
  out.rotation_rate = rotation.rate();
  out.return_mode = return_mode_of(payload[model_.tail_offset() + model_.tail.return_mode]);
  out.counter = counter(payload);
  out.cut_azimuth = rotation.cut_azimuth();
  out.zero_crossing = rotation.zero_crossing(first_pulse_, datagram.last_firing);
  if (out.zero_crossing) *out.zero_crossing -= datagram.last_firing;

  const Beams beams = beams_at(options_.firing_correction ? out.rotation_rate : 0.0);
  for (std::size_t block = 0; block < model_.blocks; ++block) emit_block(datagram, block, beams, out);
  return {};
}

DecodeOutcome HesaiDecoder::check(Bytes payload) const {
  const auto size = static_cast<std::uint32_t>(payload.size());
  if (size < model_.header.bytes)
    return {DecodeStatus::wrong_size, static_cast<std::uint32_t>(model_.bytes()), size};
  if (const DecodeOutcome outcome = check_header(payload); !outcome.ok()) return outcome;
  const std::size_t stated = stated_size(payload);
  if (payload.size() != stated) return {DecodeStatus::wrong_size, static_cast<std::uint32_t>(stated), size};
  for (std::size_t block = 0; block < model_.blocks && model_.block_flag_bytes() > 0; ++block) {
    const std::uint16_t flag = read_le16(payload, model_.block_offset(block));
    if (flag != kBlockFlag) return {DecodeStatus::bad_flag, kBlockFlag, flag};
  }
  if (returns(payload) == 0)
    return {DecodeStatus::wrong_return_mode, 0, payload[model_.tail_offset() + model_.tail.return_mode]};
  return {};
}

DecodeOutcome HesaiDecoder::check_header(Bytes payload) const {
  const HeaderLayout& header = model_.header;
  if (header.bytes == 0) return {};
  const std::uint16_t flag = read_le16(payload, 0);
  if (flag != kHeaderFlag) return {DecodeStatus::bad_flag, kHeaderFlag, flag};
  const std::uint32_t protocol = model_.protocol == 0 ? 0U : payload[header.protocol];
  const std::uint8_t unit = payload[header.distance_unit];
  const auto lasers = static_cast<std::uint32_t>(model_.lasers);
  const auto blocks = static_cast<std::uint32_t>(model_.blocks);
  const std::uint32_t wanted =
      packed(model_.protocol, lasers, blocks, std::clamp(unit, kMinDistanceUnit, kMaxDistanceUnit));
  const std::uint32_t seen = packed(protocol, payload[header.lasers], payload[header.blocks], unit);
  if (seen != wanted) return {DecodeStatus::wrong_layout, wanted, seen};
  return {};
}

std::size_t HesaiDecoder::stated_size(Bytes payload) const {
  const std::size_t size = model_.bytes();
  if (!model_.has_flags()) return payload.size() == size + kSequenceBytes ? size + kSequenceBytes : size;
  const std::uint8_t flags = payload[model_.header.flags];
  return size + ((flags & kSequenceBit) != 0 ? kSequenceBytes : 0) +
         ((flags & kSignatureBit) != 0 ? kSignatureBytes : 0);
}

std::size_t HesaiDecoder::returns(Bytes payload) const {
  const std::size_t n = returns_of_mode(payload[model_.tail_offset() + model_.tail.return_mode]);
  return n <= model_.max_returns ? n : 0;
}

double HesaiDecoder::distance_unit(Bytes payload) const {
  const bool stated = model_.header.bytes != 0;
  return (stated ? payload[model_.header.distance_unit] : model_.distance_unit_mm) * 0.001;
}

std::optional<PacketCounter> HesaiDecoder::counter(Bytes payload) const {
  const bool counted = model_.has_flags() ? (payload[model_.header.flags] & kSequenceBit) != 0
                                          : payload.size() > model_.bytes();
  if (!counted) return std::nullopt;
  PacketCounter count = kCounterWrap;
  count.value = read_le32(payload, model_.bytes());
  return count;
}

DecodeOutcome HesaiDecoder::read_azimuths(Datagram& datagram) const {
  std::array<int, kMaxBlocks> azimuths{};
  for (std::size_t block = 0; block < model_.blocks; ++block) {
    const int azimuth = read_le16(datagram.bytes, model_.azimuth_offset(block));
    int& shared = azimuths[block / datagram.returns];
    const bool further_return = block % datagram.returns != 0;
    if (azimuth >= kCentidegrees || (further_return && azimuth != shared))
      return {DecodeStatus::bad_azimuth, 0, static_cast<std::uint32_t>(azimuth)};
    shared = azimuth;
  }
  const double rpm = read_le16(datagram.bytes, model_.tail_offset() + model_.tail.motor_speed);
  int worst = 0;
  const auto rotation = read_rotation(std::span(azimuths).first(model_.blocks / datagram.returns), rpm,
                                      model_.block_period, worst);
  if (!rotation) return {DecodeStatus::bad_azimuth, 0, static_cast<std::uint32_t>(worst)};
  datagram.rotation = *rotation;
  return {};
}

HesaiDecoder::Beams HesaiDecoder::beams_at(double rate) const {
  Beams beams;
  for (std::size_t k = 0; k < model_.lasers; ++k) {
    const double elevation = radians(angles_[k].elevation_deg);
    const double azimuth = radians(angles_[k].azimuth_deg) + rate * to_seconds(model_.firing[k]);
    beams[k] = {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                std::sin(elevation)};
  }
  return beams;
}

void HesaiDecoder::emit_block(const Datagram& datagram, std::size_t block, const Beams& beams,
                              DecodedPacket& out) const {
  const std::size_t group = block / datagram.returns;
  const std::size_t first = group * datagram.returns;
  const double azimuth = radians(datagram.rotation.azimuth[group] * 0.01);
  const double c = std::cos(azimuth);
  const double s = std::sin(azimuth);
  const Nanoseconds block_time = datagram.rotation.time[group] - datagram.last_firing;
  for (std::size_t k = 0; k < model_.lasers; ++k) {
    const std::size_t at = model_.return_offset(block, k);
    const std::uint16_t raw = read_le16(datagram.bytes, at);
    if (raw == 0) continue;
    bool again = false;
    bool farthest = true;
    for (std::size_t other = first; other < first + datagram.returns; ++other) {
      const std::uint16_t distance = read_le16(datagram.bytes, model_.return_offset(other, k));
      again = again || (other < block && distance == raw);
      farthest = farthest && distance <= raw;
    }
    if (again && !options_.repeated_echoes) continue;

    const double range = raw * datagram.distance_unit;
    LidarPoint& point = out.points.emplace_back();
    point.x = static_cast<float>(range * (c * beams[k].forward + s * beams[k].left));
    point.y = static_cast<float>(range * (c * beams[k].left - s * beams[k].forward));
    point.z = static_cast<float>(range * beams[k].up);
    point.dt_ns = static_cast<std::int32_t>((block_time + model_.firing[k]).count());
    point.intensity = datagram.bytes[at + 2];
    point.channel = static_cast<std::uint8_t>(k);
    point.echo = farthest && !again ? std::uint8_t{0} : std::uint8_t{1};
  }
}

std::string HesaiDecoder::explain(const DecodeOutcome& outcome) const {
  char text[96];
  switch (outcome.status) {
    case DecodeStatus::ok:
      return "ok";
    case DecodeStatus::wrong_size:
      std::snprintf(text, sizeof text, "expected datagrams of %u bytes, saw %u bytes", outcome.expected,
                    outcome.seen);
      return text;
    case DecodeStatus::bad_flag:
      std::snprintf(text, sizeof text, "expected flag 0x%04X, saw 0x%04X", outcome.expected, outcome.seen);
      return text;
    case DecodeStatus::wrong_layout:
      return "expected " + layout_name(outcome.expected) + ", saw " + layout_name(outcome.seen);
    case DecodeStatus::wrong_return_mode:
      std::snprintf(text, sizeof text,
                    "expected return mode 0x33, 0x37, 0x38, 0x39, 0x3B%s or 0x3C, saw 0x%02X",
                    model_.max_returns > 2 ? ", 0x3D" : "", outcome.seen);
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

}  // namespace hulltrack::hesai
