#include "daemon/config/conversions.hpp"

#include <array>
#include <utility>

#include "core/geometry/se3.hpp"

namespace hulltrack {
namespace {

Point corner(const std::array<double, 6>& box, std::size_t first) {
  return {static_cast<float>(box[first]), static_cast<float>(box[first + 1]),
          static_cast<float>(box[first + 2])};
}

}  // namespace

std::vector<SensorConfig> sensor_configs(const std::vector<LidarConfig>& lidars) {
  std::vector<SensorConfig> sensors;
  for (const LidarConfig& lidar : lidars) {
    SensorConfig sensor{lidar.mount, lidar.min_range, lidar.max_range, {}};
    for (const auto& box : lidar.exclude) {
      sensor.exclude.push_back({corner(box, 0), corner(box, 3)});
    }
    sensors.push_back(std::move(sensor));
  }
  return sensors;
}

Joints joints_from_plc(double travel_m, double slew_deg, double luff_deg) {
  return {travel_m, radians(slew_deg), radians(luff_deg)};
}

}  // namespace hulltrack
