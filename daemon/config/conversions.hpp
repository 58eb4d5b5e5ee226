// The configuration, and what the PLC sends, in the units and terms of the core. Pure.
#pragma once

#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/kinematics/joints.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack {

/// The configuration's LiDARs in the tracker's terms, in the order of Scan::lidars.
[[nodiscard]] std::vector<SensorConfig> sensor_configs(const std::vector<LidarConfig>& lidars);

/// Joint values in the PLC's units (m, deg) to SI.
[[nodiscard]] Joints joints_from_plc(double travel_m, double slew_deg, double luff_deg);

}  // namespace hulltrack
