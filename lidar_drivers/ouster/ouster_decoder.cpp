#include "lidar_drivers/ouster/ouster_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/ouster/ouster_pixels.hpp"

namespace hulltrack::ouster {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Columns come evenly to 5 % on a real sensor. A step of the time stamps beyond this factor of the nominal
/// one either way is not the rotor's but the clock's that was set between two columns.
constexpr double kMaxUnevenness = 2.0;
/// Stamps are kept below 146 years, so that the difference of two fits their type whatever a sensor sends.
constexpr std::uint64_t kStampMask = (std::uint64_t{1} << 62) - 1;

std::uint64_t read_le64(Bytes bytes, std::size_t offset) {
  return read_le32(bytes, offset) | std::uint64_t{read_le32(bytes, offset + 4)} << 32;
}

std::uint64_t read_serial(Bytes payload) {
  return read_le32(payload, kSerialOffset) | std::uint64_t{payload[kSerialOffset + 4]} << 32;
}

}  // namespace

/// What the columns' headers say. Only used columns are listed: the valid ones or, if none is, all.
struct OusterDecoder::Columns {
  struct Column {
    std::size_t at;  // of its header in the datagram
    int id;
    std::uint64_t stamp;  // ns
    Nanoseconds dt;       // to the last column's, <= 0
  };
  std::array<Column, kMaxColumns> column;
  std::size_t count = 0;
  bool valid = false;

  [[nodiscard]] const Column& first() const { return column[0]; }
  [[nodiscard]] const Column& last() const { return column[count - 1]; }
};

OusterDecoder::OusterDecoder(const Metadata& metadata, const DecoderOptions& options)
    : metadata_(metadata), options_(options) {
  for (const Beam& beam : metadata.beams) {
    beams_.push_back({std::cos(beam.altitude) * std::cos(-beam.azimuth),
                      std::cos(beam.altitude) * std::sin(-beam.azimuth), std::sin(beam.altitude)});
  }
  const int columns = metadata.columns_per_frame;
  for (int id = 0; id < columns; ++id) {
    const double angle = kTurn * (1.0 - static_cast<double>(id) / columns);
    angles_.push_back({std::cos(angle), std::sin(angle)});
  }
  const auto in_window = [&](int id) {
    const bool after_first = id >= metadata.window_first;
    const bool before_last = id <= metadata.window_last;
    return metadata.window_first <= metadata.window_last ? after_first && before_last
                                                         : after_first || before_last;
  };
  const auto a_packet = static_cast<int>(metadata.columns_per_packet);
  for (int begin = 0; begin < columns; begin += a_packet) {
    bool sent = false;
    for (int id = begin; id < begin + a_packet; ++id) sent = sent || in_window(id);
    packet_of_frame_.push_back(sent ? packets_per_frame_++ : -1);
  }
}

DecodeOutcome OusterDecoder::decode(std::span<const std::uint8_t> payload, DecodedPacket& out) const {
  out.points.clear();
  if (const DecodeOutcome outcome = check(payload); !outcome.ok()) return outcome;
  Columns columns;
  if (const DecodeOutcome outcome = read_columns(payload, columns); !outcome.ok()) return outcome;
  tell_rotation(payload, columns, out);
  if (!columns.valid) return {};
  switch (metadata_.profile) {
    case Profile::legacy:
      emit<LegacyPixel>(payload, columns, out);
      break;
    case Profile::rng19:
      emit<Rng19Pixel>(payload, columns, out);
      break;
    case Profile::rng19_dual:
      emit<Rng19DualPixel>(payload, columns, out);
      break;
    case Profile::rng15:
      emit<Rng15Pixel>(payload, columns, out);
      break;
  }
  return {};
}

DecodeOutcome OusterDecoder::check(std::span<const std::uint8_t> payload) const {
  const std::size_t expected = metadata_.packet_bytes();
  if (payload.size() != expected) {
    return {DecodeStatus::wrong_size, static_cast<std::uint32_t>(expected),
            static_cast<std::uint32_t>(payload.size())};
  }
  if (metadata_.profile == Profile::legacy) return {};
  const std::uint16_t type = read_le16(payload, 0);
  if (type != kLidarPacket) return {DecodeStatus::wrong_layout, kLidarPacket, type};
  const std::uint64_t serial = read_serial(payload);
  if (serial != 0 && metadata_.serial != 0 && serial != metadata_.serial) {
    return {DecodeStatus::wrong_product, static_cast<std::uint32_t>(metadata_.serial),
            static_cast<std::uint32_t>(serial)};
  }
  return {};
}

DecodeOutcome OusterDecoder::read_columns(std::span<const std::uint8_t> payload, Columns& columns) const {
  const bool legacy = metadata_.profile == Profile::legacy;
  const std::size_t bytes = metadata_.layout().column_bytes(metadata_.beams.size());
  const auto is_valid = [&](std::size_t at) {
    if (legacy) return read_le32(payload, at + bytes - metadata_.layout().column_footer) == kLegacyValid;
    return (read_le16(payload, at + kColumnStatusOffset) & 1U) != 0;
  };
  const std::size_t begin = metadata_.layout().packet_header;
  const std::size_t end = begin + metadata_.columns_per_packet * bytes;
  for (std::size_t at = begin; at < end; at += bytes) columns.valid = columns.valid || is_valid(at);
  for (std::size_t at = begin; at < end; at += bytes) {
    if (columns.valid && !is_valid(at)) continue;
    const int id = read_le16(payload, at + kMeasurementIdOffset);
    const bool forward = columns.count == 0 || id > columns.last().id;
    if (id >= metadata_.columns_per_frame || (columns.valid && !forward)) {
      return {DecodeStatus::bad_azimuth, static_cast<std::uint32_t>(metadata_.columns_per_frame),
              static_cast<std::uint32_t>(id)};
    }
    columns.column[columns.count++] = {at, id, read_le64(payload, at) & kStampMask, {}};
  }

  const double nominal = 1e9 / (metadata_.columns_per_frame * metadata_.frames_per_second);
  bool even = true;
  for (std::size_t i = 1; i < columns.count; ++i) {
    const double steps = columns.column[i].id - columns.column[i - 1].id;
    const auto gap =
        static_cast<double>(columns.column[i].stamp) - static_cast<double>(columns.column[i - 1].stamp);
    even = even && gap >= steps * nominal / kMaxUnevenness && gap <= steps * nominal * kMaxUnevenness;
  }
  for (std::size_t i = 0; i < columns.count; ++i) {
    Columns::Column& column = columns.column[i];
    const double steps = columns.last().id - column.id;
    column.dt = even ? Nanoseconds(static_cast<std::int64_t>(column.stamp - columns.last().stamp))
                     : Nanoseconds(std::min(0LL, -std::llround(steps * nominal)));
  }
  return {};
}

void OusterDecoder::tell_rotation(std::span<const std::uint8_t> payload, const Columns& columns,
                                  DecodedPacket& out) const {
  const double per_frame = metadata_.columns_per_frame;
  const double nominal = 1.0 / (per_frame * metadata_.frames_per_second);  // s a column
  const int steps = columns.last().id - columns.first().id;
  out.duration = -columns.first().dt;
  const bool timed = steps > 0 && out.duration > Nanoseconds::zero();
  const double spacing = timed ? to_seconds(out.duration) / steps : nominal;
  out.interval = Nanoseconds(std::llround(static_cast<double>(metadata_.columns_per_packet) * spacing * 1e9));
  out.sensor_time = Nanoseconds(static_cast<std::int64_t>(columns.last().stamp));
  out.clock_reference = metadata_.clock_reference;
  out.zero_crossing.reset();
  if (columns.first().id == 0) out.zero_crossing = columns.first().dt;
  out.first_azimuth = kTurn * columns.first().id / per_frame;
  out.last_azimuth = kTurn * columns.last().id / per_frame;
  out.rotation_rate = kTurn / (per_frame * spacing);
  out.return_mode = metadata_.profile == Profile::rng19_dual ? ReturnMode::dual : ReturnMode::strongest;
  out.counter = counter(payload, columns);
  out.cut_azimuth.reset();
  const int after_window = (metadata_.window_last + 1) % metadata_.columns_per_frame;
  if (after_window != metadata_.window_first) out.cut_azimuth = kTurn * metadata_.window_last / per_frame;
}

std::optional<PacketCounter> OusterDecoder::counter(std::span<const std::uint8_t> payload,
                                                    const Columns& columns) const {
  const auto group = [&](int id) { return static_cast<std::size_t>(id) / metadata_.columns_per_packet; };
  const std::size_t index = group(columns.first().id);
  const int in_frame = packet_of_frame_[index];
  if (in_frame < 0 || group(columns.last().id) != index) return std::nullopt;
  const bool legacy = metadata_.profile == Profile::legacy;
  const std::uint64_t frame =
      read_le16(payload, legacy ? columns.first().at + kLegacyFrameIdOffset : kFrameIdOffset);
  const auto a_frame = static_cast<std::uint64_t>(packets_per_frame_);
  return PacketCounter{frame * a_frame + static_cast<std::uint64_t>(in_frame), kFrameIds * a_frame};
}

/// p = (r - n) R Rz(th_e) b + R Rz(th_e) o + t: the matrix and the vector are worked out once a column.
template <typename Pixel>
void OusterDecoder::emit(std::span<const std::uint8_t> payload, const Columns& columns,
                         DecodedPacket& out) const {
  constexpr double kMetres = 1e-3;
  const Eigen::Matrix3d sensor = metadata_.lidar_to_sensor.linear() * kMetres;
  const Eigen::Vector3d origin(metadata_.beam_origin_x, 0.0, metadata_.beam_origin_z);
  for (std::size_t i = 0; i < columns.count; ++i) {
    const Angle& angle = angles_[static_cast<std::size_t>(columns.column[i].id)];
    Eigen::Matrix3d turn;
    turn << angle.cos, -angle.sin, 0.0, angle.sin, angle.cos, 0.0, 0.0, 0.0, 1.0;
    const Eigen::Matrix3d m = sensor * turn;
    const Eigen::Vector3d offset = m * origin + metadata_.lidar_to_sensor.translation();
    const auto dt = static_cast<std::int32_t>(columns.column[i].dt.count());
    std::size_t at = columns.column[i].at + metadata_.layout().column_header;
    for (std::size_t row = 0; row < beams_.size(); ++row, at += Pixel::kBytes) {
      const Direction& b = beams_[row];
      const auto point = [&](const PixelReturn& hit, std::uint8_t echo) {
        const double d = hit.range - metadata_.beam_origin_distance;
        out.points.push_back(
            {static_cast<float>(d * (m(0, 0) * b.x + m(0, 1) * b.y + m(0, 2) * b.z) + offset.x()),
             static_cast<float>(d * (m(1, 0) * b.x + m(1, 1) * b.y + m(1, 2) * b.z) + offset.y()),
             static_cast<float>(d * (m(2, 0) * b.x + m(2, 1) * b.y + m(2, 2) * b.z) + offset.z()), dt,
             hit.reflectivity, static_cast<std::uint8_t>(row), echo});
      };
      const PixelReturn first = Pixel::read(payload, at);
      if constexpr (Pixel::kDual) {
        const PixelReturn second = Pixel::read_second(payload, at);
        const bool same = first.range == second.range;
        if (first.range != 0) point(first, first.range < second.range ? 1 : 0);
        if (second.range == 0 || (same && !options_.repeated_echoes)) continue;
        point(second, first.range != 0 && second.range <= first.range ? 1 : 0);
      } else if (first.range != 0) {
        point(first, 0);
      }
    }
  }
}

std::string OusterDecoder::explain(const DecodeOutcome& outcome) const {
  switch (outcome.status) {
    case DecodeStatus::ok:
      return "ok";
    case DecodeStatus::wrong_size:
      return format_text(
          "expected datagrams of %u bytes, as the metadata's %s with %zu beams has, saw %u bytes",
          outcome.expected, std::string(metadata_.layout().name).c_str(), metadata_.beams.size(),
          outcome.seen);
    case DecodeStatus::wrong_layout:
      return format_text("expected packet type %u (lidar), saw %u", outcome.expected, outcome.seen);
    case DecodeStatus::wrong_product:
      return format_text("expected sensor %llu, whose metadata was given, saw another one's datagrams",
                         static_cast<unsigned long long>(metadata_.serial));
    case DecodeStatus::bad_azimuth:
      return format_text("expected rising measurement ids below %u, saw %u", outcome.expected, outcome.seen);
    default:  // other vendors'
      break;
  }
  return "unknown";
}

}  // namespace hulltrack::ouster
