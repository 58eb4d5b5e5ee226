// Everything a site decides: the whole configuration file as plain values (hulltrackd.toml(5)).
//
// Composed of the settings structs of the modules that use them. Inside it is metres, radians and
// nanoseconds, except joint registers (m or deg, as the PLC's programmer thinks). Paths are absolute
// or relative to the working directory, ready to open. A default-constructed Config holds every
// default; it becomes usable with a PLC host, one LiDAR model and a map.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/kinematics/loader_kinematics.hpp"
#include "core/tracking/tracker_config.hpp"
#include "daemon/log/log_config.hpp"
#include "lidar_drivers/lidar_config.hpp"
#include "plc/plc_config.hpp"

namespace hulltrack {

struct Config {
  PlcConfig plc;
  MachineConfig machine;
  std::vector<LidarConfig> lidars;  // one or more after reading
  std::filesystem::path map_file;
  std::filesystem::path quay_file;  // empty = none
  TrackerConfig tracker;
  FramingConfig framing;
  LogConfig log;
};

}  // namespace hulltrack
