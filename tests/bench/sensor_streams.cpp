#include "tests/bench/sensor_streams.hpp"

#include <fstream>

#include "core/base/text.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/ouster/ouster_format.hpp"
#include "lidar_drivers/sim/encoder_registry.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack::bench {
namespace {

constexpr double kFar = 10.0;  // m
constexpr double kNear = 8.0;
constexpr std::uint8_t kIntensity = 100;

std::string title_of(std::string_view model, bool dual) {
  return std::string(model) + (dual ? ", dual" : "");
}

/// False: the model has no encoder, or none with so many returns.
bool make_stream(const LidarModel& model, bool dual, const test::TempFolder& folder, SensorStream& stream) {
  const auto made =
      sim::make_lidar_encoder(model.name, {.return_mode = dual ? ReturnMode::dual : ReturnMode::strongest});
  if (!made) return false;
  const sim::LidarEncoder& encoder = **made;
  const sim::SensorInformation information = encoder.information();
  stream = {};
  stream.title = title_of(model.name, dual);
  stream.config.model = model.name;
  stream.information = information.datagram;
  if (!information.calibration_name.empty()) {
    stream.config.calibration = (folder.path() / information.calibration_name).string();
    std::ofstream(stream.config.calibration) << information.calibration;
  }
  std::vector<sim::LaserReturn> returns((dual ? 2 : 1) * encoder.firings_per_packet());
  for (std::size_t i = 0; i < returns.size(); ++i)
    returns[i] = {dual && i % 2 == 1 ? kNear : kFar, kIntensity};
  for (std::uint64_t n = 0; encoder.first_firing(n) < kStreamLength; ++n) {
    stream.datagrams.push_back(encoder.encode(n, returns));
    stream.sent.push_back(encoder.last_firing(n));
  }
  return true;
}

constexpr std::size_t kRows = 128;
constexpr int kColumns = 2048;
constexpr int kTurns = 10;  // a second
constexpr std::size_t kColumnsPerPacket = 16;

std::string metadata_json(const ouster::Layout& layout) {
  std::string altitudes;
  std::string azimuths;
  for (std::size_t row = 0; row < kRows; ++row) {
    const char* comma = row == 0 ? "" : ",";
    altitudes += format_text("%s%g", comma, 21.0 - 42.0 * static_cast<double>(row) / (kRows - 1));
    azimuths += format_text("%s%g", comma, 4.2 - 2.8 * static_cast<double>(row % 4));
  }
  return format_text(
      R"({"lidar_mode": "%dx%d", "beam_altitude_angles": [%s], "beam_azimuth_angles": [%s],
"lidar_origin_to_beam_origin_mm": 15.806, "lidar_to_sensor_transform": [-1,0,0,0,0,-1,0,0,0,0,1,36.18,0,0,0,1],
"data_format": {"columns_per_frame": %d, "columns_per_packet": %zu, "udp_profile_lidar": "%s"}})",
      kColumns, kTurns, altitudes.c_str(), azimuths.c_str(), kColumns, kColumnsPerPacket,
      std::string(layout.name).c_str());
}

/// RNG19: range and reflectivity; its DUAL: both of either echo in a word, the near one first.
void write_pixel(std::span<std::uint8_t> bytes, std::size_t at, bool dual) {
  constexpr auto kCode = [](double range) { return static_cast<std::uint32_t>(range * 1e3); };
  constexpr std::uint32_t kHigh = std::uint32_t{kIntensity} << 24;
  write_le32(bytes, at, dual ? kCode(kNear) | kHigh : kCode(kFar));
  write_le32(bytes, at + 4, dual ? kCode(kFar) | kHigh : kIntensity);
}

SensorStream fastest_stream(bool dual, const test::TempFolder& folder) {
  const ouster::Layout& layout =
      ouster::layout_of(dual ? ouster::Profile::rng19_dual : ouster::Profile::rng19);
  SensorStream stream;
  stream.title = title_of("OS-1-128 2048x10", dual);
  stream.config.model = "ouster_os";
  stream.config.calibration = (folder.path() / "metadata.json").string();
  std::ofstream(stream.config.calibration) << metadata_json(layout);
  const double period_ns = 1e9 / (kColumns * kTurns);
  for (std::size_t first = 0; first < std::size_t{kColumns} * kTurns; first += kColumnsPerPacket) {
    std::vector<std::uint8_t> bytes(layout.packet_bytes(kColumnsPerPacket, kRows));
    write_le16(bytes, 0, ouster::kLidarPacket);
    write_le16(bytes, ouster::kFrameIdOffset, static_cast<std::uint16_t>(first / kColumns));
    Nanoseconds time{};
    for (std::size_t column = 0; column < kColumnsPerPacket; ++column) {
      const std::size_t at = layout.packet_header + column * layout.column_bytes(kRows);
      time = Nanoseconds(static_cast<std::int64_t>(static_cast<double>(first + column) * period_ns));
      write_le32(bytes, at, static_cast<std::uint32_t>(time.count()));
      write_le16(bytes, at + ouster::kMeasurementIdOffset,
                 static_cast<std::uint16_t>((first + column) % kColumns));
      write_le16(bytes, at + ouster::kColumnStatusOffset, 1);
      for (std::size_t row = 0; row < kRows; ++row)
        write_pixel(bytes, at + layout.column_header + row * layout.pixel, dual);
    }
    stream.datagrams.push_back(std::move(bytes));
    stream.sent.push_back(time);
  }
  return stream;
}

}  // namespace

void for_each_sensor_stream(const std::function<void(const SensorStream&)>& visit) {
  const test::TempFolder folder;
  SensorStream stream;
  for (const LidarModel& model : lidar_models()) {
    for (const bool dual : {false, true}) {
      if (make_stream(model, dual, folder, stream)) visit(stream);
    }
  }
  for (const bool dual : {false, true}) visit(fastest_stream(dual, folder));
}

}  // namespace hulltrack::bench
