#include "daemon/simulator/run/simulated_lidar.hpp"

#include <cmath>

#include "daemon/simulator/berth/loader_machine.hpp"
#include "lidar_drivers/model_registry.hpp"

namespace hulltrack {

SimulatedLidar::SimulatedLidar(Setup setup, const LidarSurroundings& around, Nanoseconds end)
    : setup_(std::move(setup)), around_(around), mount_(lidar_brackets()[setup_.bracket]) {
  packets_ = static_cast<std::uint64_t>(end / encoder().packet_interval());
  while (packets_ > 0 && sent(packets_ - 1) >= end) --packets_;
}

std::vector<sim::LaserReturn> SimulatedLidar::returns(std::uint64_t number) const {
  std::vector<sim::LaserFiring> firings;
  encoder().firings(number, firings);
  const auto sweep =
      around_.world.sweep(mount_, to_seconds(firings.front().time), to_seconds(firings.back().time));
  const DustPlume::Now dust = around_.dust.at(sweep.begin);
  RandomStream random(setup_.seed, 600 + setup_.bracket, number);
  RandomStream air_random(setup_.seed, 610 + setup_.bracket, number);
  std::vector<sim::LaserReturn> returns;
  returns.reserve(2 * firings.size());
  for (const sim::LaserFiring& firing : firings) {
    const Echoes echoes = around_.cover.hides(to_seconds(firing.time), firing.azimuth)
                              ? behind_cover(air_random)
                              : through_air(sweep, dust, firing, surface(sweep, firing, random), air_random);
    switch (setup_.return_mode) {
      case ReturnMode::dual:
        returns.push_back(echoes.last);
        returns.push_back(echoes.first);
        break;
      case ReturnMode::last:
        returns.push_back(echoes.last);
        break;
      default:
        returns.push_back(echoes.strongest());
    }
  }
  return returns;
}

Echoes SimulatedLidar::surface(const BerthWorld::Sweep& sweep, const sim::LaserFiring& firing,
                               RandomStream& random) const {
  const Point origin = firing.origin.cast<float>();
  const Point direction = firing.direction.cast<float>();
  const double t = to_seconds(firing.time);
  const auto reach = static_cast<float>(sensor().max_range);
  const auto middle = around_.world.cast(sweep, t, origin, direction, reach);
  if (!middle) return {};
  const auto other =
      around_.world.cast(sweep, t, origin, ray_within_beam(sensor(), direction, random), reach);
  return measure(sensor(), *middle, other, random);
}

Echoes SimulatedLidar::through_air(const BerthWorld::Sweep& sweep, const DustPlume::Now& dust,
                                   const sim::LaserFiring& firing, Echoes echoes,
                                   RandomStream& random) const {
  const double t = to_seconds(firing.time);
  if (around_.dust.any()) {
    const Point origin = firing.origin.cast<float>();
    const auto [origin_W, direction_W] = BerthWorld::ray_W(sweep, t, origin, firing.direction.cast<float>());
    const double reach = echoes.first.range > 0.0 ? echoes.first.range : sensor().max_range;
    if (const auto at = around_.dust.stops(dust, origin_W, direction_W, static_cast<float>(reach), random))
      echoes = behind_particle(static_cast<double>(*at), echoes, random);
  }
  if (around_.weather.when.active(t)) echoes = through_weather(around_.weather, sensor(), echoes, random);
  return echoes;
}

SimulatedLidar::Packet SimulatedLidar::packet(std::uint64_t number) const {
  return encoder().encode(number, returns(number));
}

LidarConfig SimulatedLidar::config() const {
  LidarConfig config;
  config.model = sensor().model;
  if (const LidarModel* model = find_lidar_model(config.model)) {
    config.port = model->port;
    config.information_port = model->information_port;
  }
  config.calibration = information().calibration_name;
  config.mount = mount_;
  config.min_range = sensor().min_range;
  config.max_range = sensor().max_range;
  for (const Box& box : own_machine_boxes(mount_)) {
    const auto edge = [](float metres) { return std::round(static_cast<double>(metres) * 10.0) / 10.0; };
    config.exclude.push_back({edge(box.min.x()), edge(box.min.y()), edge(box.min.z()), edge(box.max.x()),
                              edge(box.max.y()), edge(box.max.z())});
  }
  return config;
}

}  // namespace hulltrack
