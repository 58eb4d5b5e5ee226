// What is needed of an Ouster's metadata: the beams' directions, the datagram's layout, the rotor's mode.
//
// The sensor serves it as JSON (GET /api/v1/sensor/metadata; older firmware on TCP 7501), in one of two
// shapes: nested (beam_intrinsics, lidar_intrinsics, lidar_data_format, config_params, sensor_info) or, from
// older firmware and the maker's recording tools, flat. Both are read. Nothing has a default that would
// change where a point lies: a key that is missing, of another type or out of range is an error that names
// file, key and what is allowed. Never throws. Pure, but for reading the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/geometry/se3.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/ouster/ouster_format.hpp"

namespace hulltrack::ouster {

struct Beam {
  double altitude;  // rad, [-pi/2, pi/2]
  double azimuth;   // rad, [-pi/2, pi/2], counted as the metadata counts: clockwise seen from above
};

struct Metadata {
  Profile profile = Profile::legacy;
  std::size_t columns_per_packet = 16;  // divides columns_per_frame
  int columns_per_frame = 1024;         // 512, 1024, 2048
  int frames_per_second = 10;           // 10, 20
  int window_first = 0;                 // measurement ids that the sensor sends, both included;
  int window_last = 1023;               // first > last: the window goes through 0
  std::uint64_t serial = 0;             // 0 = not told
  /// By timestamp_mode and multipurpose_io_mode: how the clock is set up, not whether it has the time.
  ClockReference clock_reference = ClockReference::unknown;
  std::vector<Beam> beams;  // by pixel row: 16, 32, 64 or 128
  // Where the beams start, mm, in the lidar frame at measurement 0; the distance is included in a range.
  double beam_origin_x = 0.0;
  double beam_origin_z = 0.0;
  double beam_origin_distance = 0.0;
  Pose lidar_to_sensor = Pose::Identity();  // translation in m

  [[nodiscard]] const Layout& layout() const { return layout_of(profile); }
  [[nodiscard]] std::size_t packet_bytes() const {
    return layout().packet_bytes(columns_per_packet, beams.size());
  }
};

/// `name` is what an error calls the file.
[[nodiscard]] Result<Metadata> parse_metadata(std::string_view json, const std::string& name);
[[nodiscard]] Result<Metadata> read_metadata(const std::filesystem::path& file);

}  // namespace hulltrack::ouster
