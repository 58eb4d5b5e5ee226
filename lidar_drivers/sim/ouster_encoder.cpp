#include "lidar_drivers/sim/ouster_encoder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/base/text.hpp"
#include "lidar_drivers/bytes.hpp"

namespace hulltrack::sim {

namespace {

constexpr std::size_t kRows = 64;
/// Of an OS-1: beams from +21.2 to -21.2 deg, four columns of lasers side by side.
constexpr double kTopAltitude = 21.2;  // deg
constexpr double kAzimuths[] = {4.2, 1.4, -1.4, -4.2};
constexpr double kBeamOrigin = 15.806;  // mm
constexpr double kSensorHeight = 36.18;
constexpr std::uint64_t kSerial = 122'000'000'001;
constexpr std::uint32_t kMaxRange = 0x7FFFF;  // mm

double altitude_deg(std::size_t row) {
  return kTopAltitude * (1.0 - 2.0 * static_cast<double>(row) / (kRows - 1));
}
double azimuth_deg(std::size_t row) { return kAzimuths[row % 4]; }

ouster::Metadata nominal_metadata(ReturnMode mode, int frames_per_second) {
  ouster::Metadata metadata;
  metadata.profile = mode == ReturnMode::dual ? ouster::Profile::rng19_dual : ouster::Profile::rng19;
  metadata.frames_per_second = frames_per_second;
  metadata.serial = kSerial;
  for (std::size_t row = 0; row < kRows; ++row)
    metadata.beams.push_back({radians(altitude_deg(row)), radians(azimuth_deg(row))});
  metadata.beam_origin_x = metadata.beam_origin_distance = kBeamOrigin;
  metadata.lidar_to_sensor.linear().diagonal() << -1.0, -1.0, 1.0;
  metadata.lidar_to_sensor.translation().z() = kSensorHeight * 1e-3;
  return metadata;
}

std::uint32_t range_code(double range) {
  const double code = std::round(range * 1e3);
  return code >= 1.0 && code <= kMaxRange ? static_cast<std::uint32_t>(code) : 0;
}

void write_le64(std::span<std::uint8_t> bytes, std::size_t at, std::uint64_t value) {
  write_le32(bytes, at, static_cast<std::uint32_t>(value));
  write_le32(bytes, at + 4, static_cast<std::uint32_t>(value >> 32));
}

}  // namespace

Result<OusterEncoder> OusterEncoder::create(std::string_view model, const LidarEncoderConfig& config) {
  if (model != "ouster_os") return Error{"no Ouster model is called \"" + std::string(model) + "\""};
  if (config.rpm != 600.0 && config.rpm != 1200.0)
    return Error{format_text("an Ouster with 1024 columns turns at 600 or 1200 rpm, not at %g", config.rpm)};
  if (config.return_mode != ReturnMode::strongest && config.return_mode != ReturnMode::dual)
    return Error{"an Ouster's return mode is strongest or dual"};
  const int frames_per_second = config.rpm == 600.0 ? 10 : 20;
  return OusterEncoder(nominal_metadata(config.return_mode, frames_per_second), config);
}

OusterEncoder::OusterEncoder(ouster::Metadata metadata, const LidarEncoderConfig& config)
    : metadata_(std::move(metadata)), config_(config) {
  const double turn = 2.0 * std::numbers::pi;
  const double share = config.start_azimuth / turn - std::floor(config.start_azimuth / turn);
  first_index_ = static_cast<std::uint64_t>(share * static_cast<double>(packets_per_frame()));
}

std::uint64_t OusterEncoder::packets_per_frame() const {
  return static_cast<std::uint64_t>(metadata_.columns_per_frame) / metadata_.columns_per_packet;
}

std::size_t OusterEncoder::firings_per_packet() const { return metadata_.columns_per_packet * kRows; }

Nanoseconds OusterEncoder::packet_interval() const { return column_time(metadata_.columns_per_packet); }

Nanoseconds OusterEncoder::packet_duration() const { return column_time(metadata_.columns_per_packet - 1); }

Nanoseconds OusterEncoder::column_time(std::size_t column) const {
  const std::int64_t a_second = std::int64_t{metadata_.columns_per_frame} * metadata_.frames_per_second;
  return Nanoseconds(static_cast<std::int64_t>(column) * 1'000'000'000 / a_second);
}

int OusterEncoder::measurement_id(std::uint64_t packet, std::size_t column) const {
  const std::uint64_t in_frame = index_of(packet) % packets_per_frame();
  return static_cast<int>(in_frame * metadata_.columns_per_packet + column);
}

void OusterEncoder::firings(std::uint64_t packet, std::vector<LaserFiring>& out) const {
  out.clear();
  const double n = metadata_.beam_origin_distance * 1e-3;
  for (std::size_t column = 0; column < metadata_.columns_per_packet; ++column) {
    const Nanoseconds time = first_firing(packet) + column_time(column);
    const double encoder =
        2.0 * std::numbers::pi *
        (1.0 - static_cast<double>(measurement_id(packet, column)) / metadata_.columns_per_frame);
    for (std::size_t row = 0; row < kRows; ++row) {
      const ouster::Beam& beam = metadata_.beams[row];
      const double angle = encoder - beam.azimuth;
      const Eigen::Vector3d along(std::cos(angle) * std::cos(beam.altitude),
                                  std::sin(angle) * std::cos(beam.altitude), std::sin(beam.altitude));
      const Eigen::Vector3d start =
          n * Eigen::Vector3d(std::cos(encoder), std::sin(encoder), 0.0) - n * along;
      const Eigen::Vector3d direction = metadata_.lidar_to_sensor.linear() * along;
      out.push_back({time, std::atan2(-direction.y(), direction.x()), beam.altitude,
                     metadata_.lidar_to_sensor * start, direction, static_cast<std::uint8_t>(row)});
    }
  }
}

std::vector<std::uint8_t> OusterEncoder::encode(std::uint64_t packet,
                                                std::span<const LaserReturn> returns) const {
  const bool dual = config_.return_mode == ReturnMode::dual;
  assert(returns.size() == firings_per_packet() * (dual ? 2 : 1));
  const ouster::Layout& layout = metadata_.layout();
  std::vector<std::uint8_t> bytes(metadata_.packet_bytes());
  write_le16(bytes, 0, ouster::kLidarPacket);
  write_le16(bytes, ouster::kFrameIdOffset,
             static_cast<std::uint16_t>(index_of(packet) / packets_per_frame()));
  write_le32(bytes, ouster::kSerialOffset, static_cast<std::uint32_t>(kSerial));
  bytes[ouster::kSerialOffset + 4] = static_cast<std::uint8_t>(kSerial >> 32);
  for (std::size_t column = 0; column < metadata_.columns_per_packet; ++column) {
    const std::size_t base = layout.packet_header + column * layout.column_bytes(kRows);
    const Nanoseconds time = config_.utc + first_firing(packet) + column_time(column);
    write_le64(bytes, base, static_cast<std::uint64_t>(time.count()));
    write_le16(bytes, base + ouster::kMeasurementIdOffset,
               static_cast<std::uint16_t>(measurement_id(packet, column)));
    write_le16(bytes, base + ouster::kColumnStatusOffset, 1);
    for (std::size_t row = 0; row < kRows; ++row) {
      const std::size_t at = base + layout.column_header + row * layout.pixel;
      const std::size_t firing = column * kRows + row;
      if (!dual) {
        const std::uint32_t range = range_code(returns[firing].range);
        write_le32(bytes, at, range);
        bytes[at + 4] = range == 0 ? std::uint8_t{0} : returns[firing].intensity;
        continue;
      }
      const LaserReturn& last = returns[2 * firing];
      const LaserReturn& other = returns[2 * firing + 1];
      const std::uint32_t range = range_code(other.range);
      const std::uint32_t second = range_code(last.range) == range ? 0 : range_code(last.range);
      write_le32(bytes, at, range | (range == 0 ? 0U : std::uint32_t{other.intensity} << 24));
      write_le32(bytes, at + 4, second | (second == 0 ? 0U : std::uint32_t{last.intensity} << 24));
    }
  }
  return bytes;
}

SensorInformation OusterEncoder::information() const {
  std::string altitudes;
  std::string azimuths;
  for (std::size_t row = 0; row < kRows; ++row) {
    const char* comma = row == 0 ? "" : ", ";
    altitudes += format_text("%s%.17g", comma, altitude_deg(row));
    azimuths += format_text("%s%.17g", comma, azimuth_deg(row));
  }
  const int columns = metadata_.columns_per_frame;
  SensorInformation information;
  information.calibration_name = "metadata.json";
  information.calibration = format_text(
      R"({
  "sensor_info": {"prod_line": "OS-1-64", "prod_sn": "%llu"},
  "config_params": {"lidar_mode": "%dx%d"},
  "lidar_data_format": {"columns_per_frame": %d, "columns_per_packet": %zu, "pixels_per_column": %zu,
                        "column_window": [0, %d], "udp_profile_lidar": "%s"},
  "beam_intrinsics": {"lidar_origin_to_beam_origin_mm": %g,
                      "beam_altitude_angles": [%s],
                      "beam_azimuth_angles": [%s]},
  "lidar_intrinsics": {"lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, %g, 0, 0, 0, 1]}
}
)",
      static_cast<unsigned long long>(metadata_.serial), columns, metadata_.frames_per_second, columns,
      metadata_.columns_per_packet, kRows, columns - 1, std::string(metadata_.layout().name).c_str(),
      kBeamOrigin, altitudes.c_str(), azimuths.c_str(), kSensorHeight);
  return information;
}

}  // namespace hulltrack::sim
