#include "daemon/simulator/sensing/weather.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hulltrack {
namespace {

/// Drawn with density ~ exp(-range / kScale) between `nearest` and `farthest`.
double drop_range(double nearest, double farthest, RandomStream& random) {
  constexpr double kScale = 6.0;  // m
  const double most = 1.0 - std::exp((nearest - farthest) / kScale);
  return nearest - kScale * std::log(1.0 - most * random.uniform());
}

sim::LaserReturn dimmed(const Weather& weather, const SensorTraits& sensor, const sim::LaserReturn& clear,
                        double noise, double luck) {
  if (clear.range <= 0.0) return {};
  const double depth = clear.range / weather.visibility;
  if (luck < depth * depth) return {};
  const double own = sensor.range_sigma;
  const double more = std::sqrt(std::max(0.0, weather.range_sigma * weather.range_sigma - own * own));
  const double range = clear.range + more * noise;
  if (range < sensor.min_range) return {};
  return {range, clear.intensity};
}

}  // namespace

bool WindowCover::hides(double t, double azimuth) const {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double past = std::fmod(azimuth - from, kTurn);
  return (past < 0.0 ? past + kTurn : past) < width && when.active(t);
}

Echoes behind_cover(RandomStream& random) {
  constexpr double kReturnShare = 0.3;
  if (random.uniform() >= kReturnShare) return {};
  const sim::LaserReturn near{random.uniform(0.4, 0.95), 20};
  return {near, near};
}

Echoes behind_particle(double range, const Echoes& echoes, RandomStream& random) {
  constexpr double kPastIt = 0.5;
  constexpr std::uint8_t kShine = 3;
  const sim::LaserReturn particle{range, kShine};
  const bool surface_too = random.uniform() < kPastIt && echoes.last.range > 0.0;
  return {particle, surface_too ? echoes.last : particle, false};
}

Echoes through_weather(const Weather& weather, const SensorTraits& sensor, const Echoes& echoes,
                       RandomStream& random) {
  constexpr double kGap = 0.5;  // m before the surface: nearer drops merge with it
  const double luck = random.uniform();
  const double noise = random.gaussian();
  const double lost = random.uniform();
  const auto seen_of = [&](const sim::LaserReturn& echo) {
    return dimmed(weather, sensor, echo, noise, lost);
  };
  Echoes seen{seen_of(echoes.first), seen_of(echoes.last), echoes.last_is_strongest};
  if (seen.last.range <= 0.0) seen = {seen.first, seen.first};
  if (luck >= weather.false_share + weather.drop_out) return seen;
  if (luck >= weather.false_share) return {};
  const double surface = echoes.first.range > 0.0 ? echoes.first.range : sensor.max_range;
  if (surface - kGap <= sensor.min_range) return seen;
  return behind_particle(drop_range(sensor.min_range, surface - kGap, random), seen, random);
}

}  // namespace hulltrack
