// What each LiDAR sends in a second when every beam returns: for the benchmarks of receiving and decoding.
//
// Every model that has an encoder, with one return and with two; and the fastest of all, an OS-1-128 at 2048
// columns and 10 Hz: 2.6 million firings a second. Everything is 10 m away, the other echo 8 m.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack::bench {

struct SensorStream {
  std::string title;                                 // model and mode
  LidarConfig config;                                // its calibration file exists during the visit
  std::vector<std::uint8_t> information;             // datagram to be known before the others; may be empty
  std::vector<std::vector<std::uint8_t>> datagrams;  // of one second
  std::vector<Nanoseconds> sent;                     // of each, its last firing
};

inline constexpr Nanoseconds kStreamLength = std::chrono::seconds(1);

/// Calls `visit` for one stream after the other.
void for_each_sensor_stream(const std::function<void(const SensorStream&)>& visit);

}  // namespace hulltrack::bench
