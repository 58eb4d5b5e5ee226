// What is known of a LiDAR model before the first datagram: a row of the model registry.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "core/base/result.hpp"
#include "lidar_drivers/decoder.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack {

struct LidarModel {
  std::string_view name = {};  // as in the configuration
  std::string_view vendor = {};
  std::string_view title = {};  // the maker's own name
  std::uint16_t port = 0;       // UDP port from the factory
  double range = 0.0;           // m, the maker's statement
  int channels = 0;

  enum class Calibration : std::uint8_t { none, optional, required } calibration = Calibration::none;
  std::string_view calibration_file = {};  // what it is, for tables and messages; empty with none
  std::uint16_t information_port =
      0;                // where the sensor tells about itself, from the factory; 0 = it does not
  bool rotates = true;  // false: no turns to cut frames at
  /// What a site should set. `receive` for every model so far: it needs no synchronisation, and a kernel
  /// stamp is within some tens of microseconds on a quiet network, 0.1 mm at the speed of a boom's tip.
  TimeSource time_source = TimeSource::receive;
  std::string_view clock_by = {};  // how its clock can be synchronised, for `time_source` sensor

  /// An error says what is wrong with the calibration file. An empty path: none is given.
  using Make = std::function<Result<std::unique_ptr<Decoder>>(const DecoderOptions&,
                                                              const std::filesystem::path& calibration)>;
  Make make_decoder = {};  // through make_lidar_decoder()

  /// Where a file is required: could these bytes be its datagram? For telling a person what arrives.
  std::function<bool(std::span<const std::uint8_t>)> looks_like = {};
};

}  // namespace hulltrack
