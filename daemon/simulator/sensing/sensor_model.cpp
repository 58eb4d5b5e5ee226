#include "daemon/simulator/sensing/sensor_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hulltrack {
namespace {

std::vector<SensorTraits> make_sensors() {
  return {
      {"velodyne_vlp16", 1.0, 100.0, 50.0, 0.02, 0.0030, 0.0015},
      {"velodyne_vlp32c", 1.0, 120.0, 90.0, 0.02, 0.0030, 0.0015},
      {"ouster_os", 1.0, 120.0, 45.0, 0.02, 0.0031, 0.0031},
      {"hesai_xt32", 1.0, 120.0, 80.0, 0.01, 0.0010, 0.0026},
      {"robosense_helios32", 1.0, 120.0, 110.0, 0.02, 0.0017, 0.0035},
      {"livox_mid360", 1.0, 70.0, 40.0, 0.02, 0.0026, 0.0026},
  };
}

double reflectivity(Material material) {
  switch (material) {
    case Material::steel:
      return 0.35;
    case Material::dark_steel:
      return 0.12;
    case Material::white_paint:
      return 0.70;
    case Material::concrete:
      return 0.40;
    case Material::ore:
      return 0.15;
    case Material::glass:
      return 0.06;
    case Material::rubber:
      return 0.05;
    case Material::water:
      return 0.01;
  }
  return 0.0;
}

double received_power(const RayHit& hit) {
  const auto range = static_cast<double>(hit.distance);
  return reflectivity(hit.material) * static_cast<double>(hit.cos_incidence) / (range * range);
}

Echoes only(const sim::LaserReturn& echo) { return {echo, echo}; }

}  // namespace

const std::vector<SensorTraits>& simulated_sensors() {
  static const std::vector<SensorTraits> all = make_sensors();
  return all;
}

const SensorTraits* find_sensor(std::string_view model) {
  const auto& all = simulated_sensors();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SensorTraits& s) { return s.model == model; });
  return found == all.end() ? nullptr : &*found;
}

Point ray_within_beam(const SensorTraits& sensor, const Point& direction, RandomStream& random) {
  const double radius = 0.5 * std::sqrt(random.uniform());
  const double angle = 2.0 * std::numbers::pi * random.uniform();
  const Point across =
      Point(-direction.y(), direction.x(), 0.0F).normalized();  // towards growing angle about z
  const Point along = direction.cross(across);
  const auto a = static_cast<float>(radius * std::cos(angle) * sensor.divergence_azimuth);
  const auto e = static_cast<float>(radius * std::sin(angle) * sensor.divergence_elevation);
  return (direction + a * across + e * along).normalized();
}

Echoes measure(const SensorTraits& sensor, const RayHit& middle, const std::optional<RayHit>& other,
               RandomStream& random) {
  constexpr double kPulseLength = 0.9;  // m of range within which two echoes merge (6 ns)
  constexpr double kSpeckle = 0.25;     // sigma of the received power's logarithm
  constexpr double kDarkReflectivity = 0.10;
  // How much of the pulse falls on the surface of the middle ray: at an edge any larger share.
  const double share = random.uniform(0.3, 1.0);
  const double speckle = std::exp(kSpeckle * random.gaussian());
  const double noise = sensor.range_sigma * random.gaussian();

  const double middle_power = share * received_power(middle);
  const double other_power = other ? (1.0 - share) * received_power(*other) : 0.0;
  const double power = (middle_power + other_power) * speckle;
  const double faintest = kDarkReflectivity / (sensor.range_of_dark * sensor.range_of_dark);
  const auto echo = [&](double surface, double its_power) -> sim::LaserReturn {
    const double range = surface + noise;
    if (its_power < faintest || range < sensor.min_range) return {};
    return {range, static_cast<std::uint8_t>(std::clamp(100.0 * its_power * range * range, 1.0, 100.0))};
  };
  const auto middle_range = static_cast<double>(middle.distance);
  const double other_range = other ? static_cast<double>(other->distance) : middle_range;
  if (std::abs(middle_range - other_range) < kPulseLength) {
    const double range =
        (middle_power * middle_range + other_power * other_range) / (middle_power + other_power);
    return only(echo(range, power));
  }
  const bool middle_wins = middle_power >= other_power;
  const auto winner = echo(middle_wins ? middle_range : other_range, power);
  const auto loser =
      echo(middle_wins ? other_range : middle_range, (middle_wins ? other_power : middle_power) * speckle);
  if (winner.range <= 0.0 || loser.range <= 0.0) return only(winner);
  return winner.range < loser.range ? Echoes{winner, loser, false} : Echoes{loser, winner, true};
}

}  // namespace hulltrack
