// What a site says about one LiDAR: [[lidar]] of the configuration (ICD 5).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

enum class TimeSource { receive, sensor };

struct LidarConfig {
  std::string name = "boom";
  std::string model;  // a name of the model registry
  std::string bind = "0.0.0.0";
  std::uint16_t port = 2368;
  std::uint16_t information_port = 0;  // where the sensor tells about itself; 0 = it does not
  std::string source;                  // only datagrams from this address; empty = any
  std::string multicast;               // group to join; empty = none
  std::string calibration;             // file, absolute after reading; empty = none
  Pose mount = Pose::Identity();       // T_lidar: L -> boom
  double min_range = 1.0;              // m
  double max_range = 120.0;            // m
  Nanoseconds timeout = std::chrono::milliseconds(500);
  TimeSource time_source = TimeSource::receive;
  bool firing_correction = true;
  std::string place;  // FILE:LINE of its section, for messages; empty = not from a file
  std::vector<std::array<double, 6>> exclude;  // boxes in L: x0,y0,z0,x1,y1,z1, m
};

/// What ends a frame: a grid of equal periods, or the azimuth passing through zero.
enum class Framing { period, revolution };

/// How the packets of all LiDARs are cut into scans: framing and frame_rate_hz of [tracking].
struct FramingConfig {
  Framing framing = Framing::period;
  double frame_rate_hz = 10.0;  // of the periods; with revolution framing the rate that is expected
};

}  // namespace hulltrack
