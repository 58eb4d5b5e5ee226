#include "lidar_drivers/robosense/robosense_decoder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/robosense/robosense_rotation.hpp"
#include "lidar_drivers/rotor.hpp"

namespace hulltrack::robosense {

namespace {

struct Heading {
  double cos, sin;
};
using Headings = std::array<Heading, kCentidegrees>;

/// Of every azimuth that the format can name, by 0.01 deg.
const Headings& headings() {
  static const Headings kHeadings = [] {
    Headings all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double angle = radians(static_cast<double>(i) * 0.01);
      all[i] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return kHeadings;
}

double centidegrees_to_rad(double value) { return radians(value * 0.01); }

/// The sensor's clock, ns since 1970. Any bytes give a time that fits: seconds are taken modulo 2^33.
Nanoseconds read_clock(Bytes payload, Family family) {
  const Bytes c = payload.subspan(kClockOffset, 10);
  if (family == Family::helios) {
    const std::uint64_t seconds = static_cast<std::uint64_t>(read_be16(c, 0)) << 32 | read_be32(c, 2);
    return std::chrono::seconds(static_cast<std::int64_t>(seconds & 0x1FFFFFFFFU)) +
           std::chrono::microseconds(read_be32(c, 6));
  }
  // A clock that was never set may name month or day 0.
  const std::chrono::year_month_day date{std::chrono::year(2000 + c[0]),
                                         std::chrono::month(std::clamp<unsigned>(c[1], 1, 12)),
                                         std::chrono::day(std::clamp<unsigned>(c[2], 1, 31))};
  return std::chrono::sys_days(date).time_since_epoch() + std::chrono::hours(c[3]) +
         std::chrono::minutes(c[4]) + std::chrono::seconds(c[5]) +
         std::chrono::milliseconds(read_be16(c, 6)) + std::chrono::microseconds(read_be16(c, 8));
}

bool same_lasers(const Difop& a, const Difop& b) {
  return std::ranges::equal(std::span(a.angles).first(a.lasers), std::span(b.angles).first(b.lasers));
}

std::string unit_of(std::size_t lasers, bool to_zenith) {
  return "a unit of " + std::to_string(lasers) + " lasers" + (to_zenith ? " up to the zenith" : "");
}

/// The model that a unit is, to be asked for; empty when there is none of the family.
std::string question(const Difop& unit, Family family) {
  for (const ModelTable& model : models()) {
    if (fits(unit, model) && model.family == family) return ": model = " + std::string(model.name) + "?";
  }
  return {};
}

}  // namespace

RobosenseDecoder::RobosenseDecoder(const ModelTable& model, const DecoderOptions& options)
    : model_(model), options_(options), last_pulse_(std::ranges::max(model.pulse)) {}

bool RobosenseDecoder::inform(std::span<const std::uint8_t> payload) {
  if (!is_difop(payload)) return false;
  const auto difop = read_difop(payload, model_);
  if (!difop) return false;
  inform(*difop);
  return true;
}

void RobosenseDecoder::inform(const Difop& unit) {
  const bool contradicted = told_ && !same_lasers(*told_, unit);
  told_ = unit;
  if (contradicted) {
    unit_.reset();
    return;
  }
  unit_ = unit;
  for (std::size_t k = 0; k < model_.lasers; ++k) {
    const double elevation = radians(unit_->angles[k].elevation_deg);
    const double azimuth = radians(unit_->angles[k].azimuth_deg);
    beams_[k] = {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                 std::sin(elevation)};
  }
}

DecodeOutcome RobosenseDecoder::decode(std::span<const std::uint8_t> payload, DecodedPacket& out) const {
  out.points.clear();
  if (const DecodeOutcome outcome = check(payload); !outcome.ok()) return outcome;
  Rotation rotation;
  if (const DecodeOutcome outcome = read_rotation(payload, rotation); !outcome.ok()) return outcome;

  const std::size_t last = rotation.groups - 1;
  const double last_share =
      static_cast<double>(rotation.last_pulse.count()) / static_cast<double>(rotation.span.count());
  const double last_azimuth = rotation.azimuth[last] + rotation.advance[last] * last_share;
  out.duration = rotation.duration;
  out.interval = rotation.time[last] + rotation.span;
  out.sensor_time = read_clock(payload, model_.family) + out.duration;
  out.clock_reference = unit_->clock_reference;
  out.first_azimuth = centidegrees_to_rad(rotation.azimuth[0]);
  out.last_azimuth = centidegrees_to_rad(std::fmod(last_azimuth + kCentidegrees, kCentidegrees));
  out.rotation_rate = centidegrees_to_rad(rotation.rate) / to_seconds(rotation.span);
  const ReturnMode told = unit_->mode;
  out.return_mode =
      rotation.dual ? ReturnMode::dual : (told == ReturnMode::dual ? ReturnMode::unknown : told);
  out.zero_crossing.reset();
  out.cut_azimuth.reset();
  out.counter.reset();
  if (model_.tells_state) out.counter = PacketCounter{read_be32(payload, kCountOffset), kCountWrap};
  for (std::size_t g = 0; g < rotation.groups; ++g) {
    const bool has_next = g < last;
    if (has_next && rotation.jump[g]) out.cut_azimuth = centidegrees_to_rad(rotation.azimuth[g]);
    const int step = has_next ? rotation.step[g] : rotation.advance[g];
    const Nanoseconds span = has_next ? rotation.time[g + 1] - rotation.time[g] : rotation.span;
    const auto passed = rotor::time_to_zero(rotation.azimuth[g], step, span);
    if (!passed || out.zero_crossing) continue;
    const Nanoseconds crossing = rotation.time[g] + *passed - rotation.duration;
    if (crossing <= Nanoseconds::zero()) out.zero_crossing = crossing;
  }
  for (std::size_t block = 0; block < kBlocks; ++block) emit_block(payload, block, rotation, out);
  return {};
}

DecodeOutcome RobosenseDecoder::check(std::span<const std::uint8_t> payload) const {
  if (payload.size() != kPacketBytes) {
    return {DecodeStatus::wrong_size, kPacketBytes, static_cast<std::uint32_t>(payload.size())};
  }
  const bool classic = model_.family == Family::classic;
  const std::uint32_t id = classic ? kClassicId : kHeliosId;
  if (read_be32(payload, 0) != id) return {DecodeStatus::bad_flag, id, read_be32(payload, 0)};
  if (classic && read_be32(payload, 4) != kClassicIdRest) {
    return {DecodeStatus::bad_flag, kClassicIdRest, read_be32(payload, 4)};
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::uint16_t flag = read_be16(payload, kHeaderBytes + block * kBlockBytes);
    if (flag != kBlockFlag) return {DecodeStatus::bad_flag, kBlockFlag, flag};
  }
  if (!unit_) return {DecodeStatus::awaiting_angles, 0, told_ ? kContradicted : 0};
  if (!fits(*unit_, model_)) {
    return {DecodeStatus::wrong_product, static_cast<std::uint32_t>(model_.lasers),
            static_cast<std::uint32_t>(unit_->lasers)};
  }
  return {};
}

void RobosenseDecoder::emit_block(std::span<const std::uint8_t> payload, std::size_t block,
                                  const Rotation& rotation, DecodedPacket& out) const {
  static const Headings& kHeadings = headings();
  const std::size_t group = block / rotation.blocks_per_group;
  const Nanoseconds block_time = rotation.time[group] - rotation.duration;
  const std::size_t slots = kHeaderBytes + block * kBlockBytes + kBlockHeaderBytes;
  // How many bytes before a second echo's slot the first one's lies.
  const std::size_t to_first_echo = model_.lasers == 32 ? kBlockBytes : model_.lasers * kSlotBytes;
  for (std::size_t k = 0; k < kSlots; ++k) {
    const std::size_t at = slots + k * kSlotBytes;
    const std::uint16_t raw = read_be16(payload, at);
    if (raw == 0) continue;
    const bool second_half = k >= model_.lasers;
    const bool second_echo = rotation.dual && (second_half || block % rotation.blocks_per_group == 1);
    const std::uint16_t first_echo = second_echo ? read_be16(payload, at - to_first_echo) : std::uint16_t{0};
    if (first_echo == raw && !options_.repeated_echoes) continue;
    const bool second_firing = second_half && rotation.two_firings;
    if (second_firing && rotation.jump[group]) continue;

    const std::size_t laser = k % model_.lasers;
    const Nanoseconds pulse = model_.pulse[laser] + (second_firing ? model_.period : Nanoseconds::zero());
    const auto turned =
        options_.firing_correction ? rotation.advance[group] * pulse.count() / rotation.span.count() : 0;
    const auto azimuth = (rotation.azimuth[group] + turned + kCentidegrees) % kCentidegrees;
    const Heading& turn = kHeadings[static_cast<std::size_t>(azimuth)];
    const Beam& beam = beams_[laser];
    const double range = raw * model_.distance_unit;
    const double forward = range * beam.forward + model_.lens_forward;
    const double left = range * beam.left;
    LidarPoint& point = out.points.emplace_back();
    point.x = static_cast<float>(turn.cos * forward + turn.sin * left);
    point.y = static_cast<float>(turn.cos * left - turn.sin * forward);
    point.z = static_cast<float>(range * beam.up + model_.lens_up);
    point.dt_ns = static_cast<std::int32_t>((block_time + pulse).count());
    point.intensity = payload[at + 2];
    point.channel = static_cast<std::uint8_t>(laser);
    point.echo = first_echo != 0 ? std::uint8_t{1} : std::uint8_t{0};
  }
}

std::string RobosenseDecoder::explain(const DecodeOutcome& outcome) const {
  char text[160];
  switch (outcome.status) {
    case DecodeStatus::ok:
      return "ok";
    case DecodeStatus::wrong_size:
      std::snprintf(text, sizeof text, "expected datagrams of %u bytes, saw %u bytes", outcome.expected,
                    outcome.seen);
      return text;
    case DecodeStatus::bad_flag:
      std::snprintf(text, sizeof text, "expected %s 0x%04X, saw 0x%04X",
                    outcome.expected == kBlockFlag ? "block flag" : "packet id", outcome.expected,
                    outcome.seen);
      return text;
    case DecodeStatus::wrong_product:
      if (!unit_) break;
      return "expected " + unit_of(model_.lasers, model_.to_zenith) + "; this is " +
             unit_of(unit_->lasers, unit_->to_zenith) + question(*unit_, model_.family);
    case DecodeStatus::wrong_return_mode:
      if (outcome.expected == 0) {
        std::snprintf(text, sizeof text, "expected a return mode that the model has, saw 0x%02X",
                      outcome.seen);
      } else {
        std::snprintf(text, sizeof text,
                      "expected steps of %.2f deg by the DIFOP packet's return mode and speed, saw %.2f deg, "
                      "those of another return mode",
                      outcome.expected * 0.01, outcome.seen * 0.01);
      }
      return text;
    case DecodeStatus::bad_azimuth:
      std::snprintf(text, sizeof text, "expected the azimuths of a turning sensor, saw %.2f deg",
                    outcome.seen * 0.01);
      return text;
    case DecodeStatus::awaiting_angles:
      return outcome.seen == kContradicted
                 ? "expected two equal DIFOP packets in a row, saw the newest two contradict each other"
                 : "expected the unit's DIFOP packet first, saw none yet: its lasers' angles are not known";
    case DecodeStatus::wrong_layout:  // other vendors'
      break;
  }
  return "unknown";
}

}  // namespace hulltrack::robosense
