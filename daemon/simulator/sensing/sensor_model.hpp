// How does a LiDAR turn surfaces into returns? Range noise, beams that meet an edge, surfaces too dark, too
// far or too oblique to be seen.
//
// Metres and rad. Power falls with the square of the range and with the cosine of incidence (Lambert).
// The beam is two rays: its middle and one drawn from its cross-section; where they meet surfaces a pulse
// length or less apart the range lies between the two (mixed pixel), farther apart it is one of them.
// Pure functions of their arguments and the random stream.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "daemon/simulator/random.hpp"
#include "daemon/simulator/sensing/ray_scene.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack {

struct SensorTraits {
  std::string_view model;     // of the model registry
  double min_range;           // m
  double max_range;           // m, what the configuration states
  double range_of_dark;       // a head-on surface of 10 % reflectivity is just seen at this range, m
  double range_sigma;         // m
  double divergence_azimuth;  // full width of the beam, rad
  double divergence_elevation;
};

/// The models that can be simulated.
[[nodiscard]] const std::vector<SensorTraits>& simulated_sensors();
/// nullptr when there is none of that name.
[[nodiscard]] const SensorTraits* find_sensor(std::string_view model);

/// A direction within the beam around `direction` (unit), drawn evenly over its cross-section.
[[nodiscard]] Point ray_within_beam(const SensorTraits& sensor, const Point& direction, RandomStream& random);

/// The echoes of one pulse: at most two, the same twice when there is only one. Range 0: none.
struct Echoes {
  sim::LaserReturn first, last;
  bool last_is_strongest = true;

  [[nodiscard]] const sim::LaserReturn& strongest() const { return last_is_strongest ? last : first; }
};

/// The echoes of a beam whose middle and whose other ray met these surfaces. (A beam whose middle meets
/// nothing returns nothing.)
[[nodiscard]] Echoes measure(const SensorTraits& sensor, const RayHit& middle,
                             const std::optional<RayHit>& other, RandomStream& random);

}  // namespace hulltrack
