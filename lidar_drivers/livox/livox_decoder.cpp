#include "lidar_drivers/livox/livox_decoder.hpp"

#include <algorithm>
#include <chrono>

#include "core/base/text.hpp"
#include "lidar_drivers/bytes.hpp"

namespace hulltrack::livox {

namespace {

/// Stamps are kept below 146 years, so that the difference of two fits their type whatever a sensor sends.
constexpr std::uint64_t kStampMask = (std::uint64_t{1} << 62) - 1;
/// Tag, bits 0-1: doubt for the point's place.
constexpr std::uint8_t kPlaceMask = 3;
constexpr std::uint8_t kHighConfidenceOfNoise = 1;

std::uint64_t read_le64(Bytes bytes, std::size_t offset) {
  return read_le32(bytes, offset) | std::uint64_t{read_le32(bytes, offset + 4)} << 32;
}

/// ns since 1970 of a date stamp; 0 for a date that is none.
std::uint64_t date_stamp(Bytes payload, std::size_t at) {
  namespace ch = std::chrono;
  const ch::year_month_day date{ch::year(2000 + payload[at]), ch::month(payload[at + 1]),
                                ch::day(payload[at + 2])};
  const ch::hours hour(payload[at + 3]);
  const ch::microseconds within(read_le32(payload, at + 4));
  if (!date.ok() || hour >= ch::hours(24) || within >= ch::hours(1)) return 0;
  const Nanoseconds since = ch::sys_days(date).time_since_epoch() + hour + within;
  return static_cast<std::uint64_t>(since.count());
}

std::uint64_t read_stamp(Bytes payload, const Generation& generation) {
  const bool date = &generation == &kGeneration1 && payload[generation.stamp_type_offset] == kStampIsDate;
  const std::size_t at = generation.stamp_offset;
  return (date ? date_stamp(payload, at) : read_le64(payload, at)) & kStampMask;
}

DecodeOutcome wrong_size(std::size_t expected, std::size_t seen) {
  return {DecodeStatus::wrong_size, static_cast<std::uint32_t>(expected), static_cast<std::uint32_t>(seen)};
}

}  // namespace

DecodeOutcome LivoxDecoder::decode(std::span<const std::uint8_t> payload, DecodedPacket& out) const {
  out.points.clear();
  Header header;
  if (const DecodeOutcome outcome = read_header(payload, header); !outcome.ok()) return outcome;
  tell_times(payload, header, out);
  Echoes echoes{};
  std::size_t at = model_.generation->header;
  for (std::size_t shot = 0; shot < header.records; ++shot, at += header.kind->bytes) {
    int angle = 0;
    if (!read_record(payload, at, *header.kind, echoes, angle)) {
      out.points.clear();
      return {DecodeStatus::bad_azimuth, 0, static_cast<std::uint32_t>(angle)};
    }
    emit(echoes, header, shot, out);
  }
  return {};
}

bool LivoxDecoder::inform(std::span<const std::uint8_t> payload) {
  const Generation& generation = *model_.generation;
  if (payload.size() != generation.header + kImuBytes || payload[0] != generation.version) return false;
  const bool sized = &generation == &kGeneration1 || read_le16(payload, kLengthOffset) == payload.size();
  return sized && payload[generation.type_offset] == generation.imu_type;
}

DecodeOutcome LivoxDecoder::read_header(std::span<const std::uint8_t> payload, Header& header) const {
  const Generation& generation = *model_.generation;
  if (payload.size() < generation.header) return wrong_size(generation.header, payload.size());
  if (payload[0] != generation.version) return {DecodeStatus::wrong_product, generation.version, payload[0]};
  const std::uint8_t type = payload[generation.type_offset];
  const auto kind = std::ranges::find(generation.kinds, type, &RecordKind::type);
  if (kind == generation.kinds.end()) return {DecodeStatus::wrong_layout, 0, type};
  header.kind = &*kind;
  const bool told = kind->records == 0;
  header.records = told ? read_le16(payload, kDotsOffset) : kind->records;
  if (header.records == 0) return wrong_size(generation.header + kind->bytes, generation.header);
  const std::size_t expected = generation.header + header.records * kind->bytes;
  if (payload.size() != expected) return wrong_size(expected, payload.size());
  if (told && read_le16(payload, kLengthOffset) != expected)
    return wrong_size(read_le16(payload, kLengthOffset), payload.size());

  const auto steps = static_cast<std::int64_t>(header.records - 1);
  header.duration = steps * model_.shot_period;
  if (told && steps > 0 && read_le16(payload, kIntervalOffset) > 0)
    header.duration = read_le16(payload, kIntervalOffset) * kIntervalUnit;
  header.stamp = read_stamp(payload, generation);
  return {};
}

void LivoxDecoder::tell_times(std::span<const std::uint8_t> payload, const Header& header,
                              DecodedPacket& out) const {
  const auto steps = static_cast<std::int64_t>(header.records - 1);
  out.duration = header.duration;
  out.interval = steps > 0 ? header.duration * (steps + 1) / steps : model_.shot_period;
  out.sensor_time = Nanoseconds(static_cast<std::int64_t>(header.stamp)) + header.duration;
  const std::span<const ClockReference> references = model_.generation->stamp_types;
  const std::uint8_t stamp_type = payload[model_.generation->stamp_type_offset];
  out.clock_reference = stamp_type < references.size() ? references[stamp_type] : ClockReference::unknown;
  out.zero_crossing.reset();
  out.first_azimuth = out.last_azimuth = out.rotation_rate = 0.0;
  constexpr ReturnMode kModes[] = {ReturnMode::unknown, ReturnMode::dual, ReturnMode::triple};
  out.return_mode = kModes[header.kind->echoes - 1];
  out.counter.reset();
  if (model_.generation == &kGeneration2)
    out.counter = PacketCounter{read_le16(payload, kCountOffset), kCountWrap};
  out.cut_azimuth.reset();
}

void LivoxDecoder::emit(Echoes& echoes, const Header& header, std::size_t shot, DecodedPacket& out) const {
  const std::size_t count = header.kind->echoes;
  std::size_t last = 0;  // the farthest
  for (std::size_t k = 0; k < count; ++k) {
    const bool noise = model_.high_noise_is_noise && (echoes[k].tag & kPlaceMask) == kHighConfidenceOfNoise;
    if (noise) echoes[k].square = 0.0;
    if (echoes[k].square > echoes[last].square) last = k;
  }
  const auto steps = static_cast<std::int64_t>(header.records - 1);
  const auto left = steps - static_cast<std::int64_t>(shot);
  const auto dt = steps > 0 ? -(header.duration.count() * left / steps) : 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Echo& echo = echoes[k];
    if (echo.square == 0.0) continue;
    const bool repeated =
        std::any_of(echoes.begin(), echoes.begin() + static_cast<std::ptrdiff_t>(k), [&](const Echo& before) {
          return before.square > 0.0 && before.x == echo.x && before.y == echo.y && before.z == echo.z;
        });
    if (repeated && !options_.repeated_echoes) continue;
    out.points.push_back({static_cast<float>(echo.x), static_cast<float>(echo.y), static_cast<float>(echo.z),
                          static_cast<std::int32_t>(dt), echo.reflectivity,
                          static_cast<std::uint8_t>(shot % static_cast<std::size_t>(model_.lines)),
                          k == last ? std::uint8_t{0} : std::uint8_t{1}});
  }
}

std::string LivoxDecoder::explain(const DecodeOutcome& outcome) const {
  switch (outcome.status) {
    case DecodeStatus::ok:
      return "ok";
    case DecodeStatus::wrong_size:
      return format_text("expected datagrams of %u bytes, saw %u bytes", outcome.expected, outcome.seen);
    case DecodeStatus::wrong_product:
      return format_text("expected protocol version %u of a Livox %s, saw %u", outcome.expected,
                         std::string(model_.title).c_str(), outcome.seen);
    case DecodeStatus::wrong_layout:
      return format_text("expected a point data type of a Livox %s, saw 0x%02X",
                         std::string(model_.title).c_str(), outcome.seen);
    case DecodeStatus::bad_azimuth:
      return format_text("expected angles up to 180 and 360 deg, saw %.2f deg", outcome.seen * 0.01);
    default:  // other vendors'
      break;
  }
  return "unknown";
}

}  // namespace hulltrack::livox
