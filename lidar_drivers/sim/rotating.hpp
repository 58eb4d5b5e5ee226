// What the encoders of rotating sensors have in common. Pure functions.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/result.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack::sim {

/// What is wrong with the settings of one of `maker`'s sensors: a rate outside (0, most_rpm], or another
/// return mode than strongest, last or dual.
[[nodiscard]] std::optional<Error> settings_problem(const std::string& maker, double most_rpm,
                                                    const LidarEncoderConfig& config);

/// Where the rotor stands, deg, [0, 360).
[[nodiscard]] double rotor_azimuth(const LidarEncoderConfig& config, Nanoseconds time);

/// Unit vector in L; azimuth clockwise from +x seen from above, rad.
[[nodiscard]] Eigen::Vector3d direction_of(double azimuth, double elevation);

/// In units of `unit` m; 0 for what 16 bits cannot hold.
[[nodiscard]] std::uint16_t distance_code(double range, double unit);

}  // namespace hulltrack::sim
