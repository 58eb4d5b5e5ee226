#include "lidar_drivers/sim/rotating.hpp"

#include <cmath>

#include "core/geometry/se3.hpp"

namespace hulltrack::sim {

std::optional<Error> settings_problem(const std::string& maker, double most_rpm,
                                      const LidarEncoderConfig& config) {
  if (!(config.rpm > 0.0 && config.rpm <= most_rpm)) {
    return Error{"a " + maker + " cannot turn at " + std::to_string(config.rpm) + " rpm; allowed is (0, " +
                 std::to_string(most_rpm) + "]"};
  }
  const ReturnMode mode = config.return_mode;
  if (mode != ReturnMode::strongest && mode != ReturnMode::last && mode != ReturnMode::dual)
    return Error{"a " + maker + "'s return mode is strongest, last or dual"};
  return std::nullopt;
}

double rotor_azimuth(const LidarEncoderConfig& config, Nanoseconds time) {
  const double turned = degrees(config.start_azimuth) + config.rpm * 6.0 * to_seconds(time);
  const double within = std::fmod(turned, 360.0);
  return within < 0.0 ? within + 360.0 : within;
}

Eigen::Vector3d direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

std::uint16_t distance_code(double range, double unit) {
  const double code = std::round(range / unit);
  return code >= 1.0 && code <= 65535.0 ? static_cast<std::uint16_t>(code) : std::uint16_t{0};
}

}  // namespace hulltrack::sim
