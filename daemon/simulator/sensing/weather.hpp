// What happens to a beam between the LiDAR and the ship? Rain, fog, a cover on the window.
//
// Metres, seconds from the first firing, angles in rad. Everything here works on what the receiver would have
// reported of the surfaces alone (sensor_model.hpp). Pure functions of their arguments and the random stream.
#pragma once

#include <limits>

#include "daemon/simulator/random.hpp"
#include "daemon/simulator/sensing/sensor_model.hpp"
#include "daemon/simulator/spells.hpp"

namespace hulltrack {

/// Rain and fog, while they last.
struct Weather {
  Spells when = kNever;
  double false_share = 0.0;                                     // of all beams: end on a drop
  double drop_out = 0.0;                                        // of all beams: nothing comes back
  double visibility = std::numeric_limits<double>::infinity();  // m, nothing comes back from beyond
  double range_sigma = 0.0;                                     // m, in place of a better sensor's own
};

/// Something over the window: a tarpaulin, a coat of ore dust.
struct WindowCover {
  Spells when = kNever;
  double from = 0.0;   // azimuth of the sensor, clockwise from +x seen from above
  double width = 0.0;  // of the covered sector, up to 2 pi

  [[nodiscard]] bool hides(double t, double azimuth) const;
};

/// What comes back from a cover: mostly nothing, at times a return nearer than a metre.
[[nodiscard]] Echoes behind_cover(RandomStream& random);

/// A particle in the air answers from `range`, nearer than `echoes` and louder. In every second such beam
/// light goes on past it and the last echo is still the surface's.
[[nodiscard]] Echoes behind_particle(double range, const Echoes& echoes, RandomStream& random);

/// `echoes` as they arrive through the weather.
///
/// A beam ends on a drop at a range drawn with a density that falls by e every 6 m - drops near the sensor
/// fill most of the beam and answer loudest; in 25 mm/h nearly all false returns come from within 20 m -
/// nearer than the surface and beyond the sensor's least range. In fog the share that is lost on the way
/// grows as (range / visibility)^2.
[[nodiscard]] Echoes through_weather(const Weather& weather, const SensorTraits& sensor, const Echoes& echoes,
                                     RandomStream& random);

}  // namespace hulltrack
