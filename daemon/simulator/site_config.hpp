// The configuration file that belongs to a simulation: what a commissioning engineer would have written
// about this machine, sensor and ship, with the reasons as comments.
//
// TOML as in hulltrackd.toml(5); keys at their defaults are left out. Pure: the same simulation gives the
// same text.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/simulator/simulated_berth.hpp"

namespace hulltrack {

/// Where the service finds the simulated PLC and LiDAR.
struct SiteAddresses {
  std::string plc_host = "127.0.0.1";
  std::uint16_t plc_port = 1502;
  std::uint16_t lidar_port = 0;  // of its data and of what it tells about itself; 0 = the model's own
};

[[nodiscard]] std::string site_config(const SimulatedBerth& berth, const SiteAddresses& addresses);

}  // namespace hulltrack
