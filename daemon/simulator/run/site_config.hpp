// The configuration file that belongs to a simulation: what a commissioning engineer would have written
// about this machine, its sensors and this ship, with the reasons as comments.
//
// TOML as in hulltrackd.toml(5); keys at their defaults are left out. Pure: the same simulation gives the
// same text.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/simulator/run/simulated_berth.hpp"

namespace hulltrack {

/// Where the service finds the simulated PLC and LiDAR.
struct SiteAddresses {
  std::string plc_host = "127.0.0.1";
  std::uint16_t plc_port = 1502;
  /// Of the first LiDAR's data and of what it tells about itself, the next ones' ports follow. 0 = as in a
  /// recording: every model's own port, and the address that it sends from where there are several.
  std::uint16_t lidar_port = 0;
};

/// The address that LiDAR `lidar` of a recording sends from.
[[nodiscard]] constexpr std::uint32_t recorded_address(std::size_t lidar) {
  return 0xC0A801C9U + static_cast<std::uint32_t>(lidar);  // 192.168.1.201 and following
}

[[nodiscard]] std::string site_config(const SimulatedBerth& berth, const SiteAddresses& addresses);

}  // namespace hulltrack
