#include "daemon/simulator/simulated_berth.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/simulator/berth_mesh.hpp"
#include "daemon/simulator/loader_machine.hpp"
#include "daemon/simulator/ship_mesh.hpp"
#include "daemon/simulator/survey.hpp"

namespace hulltrack {
namespace {

constexpr double kRpm = 600.0;
constexpr double kFenderGap = 1.2;      // m between the quay's edge and the ship's side
constexpr double kDeckAboveQuay = 2.0;  // m, main deck amidships of the empty ship

/// Alongside the quay, bow towards +x.
Pose T_H_ship(const ShipDesign& ship) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(0.0, kFenderGap + 0.5 * static_cast<double>(ship.beam), kDeckAboveQuay);
  return T;
}

Eigen::Vector3d reference_point_H() {
  const ShipDesign ship = berth_ship();
  const Eigen::Vector3d corner = T_H_ship(ship) * landmark(ship).cast<double>();
  return (corner * 1000.0).array().round() / 1000.0;  // as a configuration states it
}

HullMotionConfig hull_motion(const SimulationOptions& options, const Scenario& scenario) {
  HullMotionConfig motion = scenario.motion;
  if (options.leave_at) {
    motion.run.start = *options.leave_at;
  }
  return motion;
}

LoaderMotion loader_motion(const SimulationOptions& options, double duration) {
  return options.parked ? LoaderMotion(*options.parked)
                        : LoaderMotion(loader_limits(), duration, options.seed);
}

std::string known_names(bool models) {
  std::string names;
  const auto add = [&](std::string_view name) { names += (names.empty() ? "" : ", ") + std::string(name); };
  if (models)
    for (const SensorTraits& sensor : simulated_sensors()) add(sensor.model);
  else
    for (const Scenario& scenario : scenarios()) add(scenario.name);
  return names;
}

}  // namespace

Result<std::unique_ptr<SimulatedBerth>> SimulatedBerth::create(const SimulationOptions& options) {
  const Scenario* scenario = find_scenario(options.scenario);
  if (scenario == nullptr)
    return Error{"there is no scenario \"" + options.scenario + "\"; there are " + known_names(false)};
  const SensorTraits* sensor = find_sensor(options.lidar_model);
  if (sensor == nullptr)
    return Error{"cannot simulate LiDAR model \"" + options.lidar_model + "\"; can simulate " +
                 known_names(true)};
  if (options.frames < 0 || options.frames > kMaxFrames)
    return Error{"the number of frames must lie between 1 and " + std::to_string(kMaxFrames)};
  if (options.leave_at && scenario->motion.run.speed == 0.0)
    return Error{"the ship of scenario \"" + options.scenario +
                 "\" never gets under way: leave out the time to leave"};
  RandomStream random(options.seed, 500);
  sim::VelodyneEncoderConfig config;
  config.rpm = kRpm;
  config.start_azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
  config.time_of_hour = kEpoch.time_since_epoch() % velodyne::kClockWrap;
  auto encoder = sim::VelodyneEncoder::create(sensor->model, config);
  if (!encoder) return encoder.error();
  return std::unique_ptr<SimulatedBerth>(new SimulatedBerth(options, *scenario, *sensor, *encoder));
}

SimulatedBerth::SimulatedBerth(const SimulationOptions& options, const Scenario& scenario,
                               const SensorTraits& sensor, sim::VelodyneEncoder encoder)
    : options_(options),
      scenario_(&scenario),
      sensor_(&sensor),
      frames_(options.frames > 0 ? options.frames : scenario.frames),
      encoder_(std::move(encoder)),
      loader_(loader_motion(options, to_seconds(frames_ * kFramePeriod))),
      hull_(hull_motion(options, scenario), reference_point_H(), options.seed),
      plc_(loader_, options.encoders, options.seed),
      world_(std::make_unique<BerthWorld>(hull_mesh_H(), loader_, hull_, sensor.mount)) {
  const Nanoseconds end = frames_ * kFramePeriod;
  packets_ = static_cast<std::uint64_t>(end / encoder_.packet_interval());
  while (packets_ > 0 && encoder_.last_firing(packets_ - 1) >= end) --packets_;
}

std::vector<sim::VelodyneReturn> SimulatedBerth::returns(std::uint64_t number) const {
  std::vector<sim::VelodyneFiring> firings;
  encoder_.firings(number, firings);
  const auto sweep = world_->sweep(to_seconds(firings.front().time), to_seconds(firings.back().time));
  RandomStream random(options_.seed, 600, number);
  std::vector<sim::VelodyneReturn> returns;
  returns.reserve(firings.size());
  for (const sim::VelodyneFiring& firing : firings) {
    const Point origin(0.0F, 0.0F, static_cast<float>(firing.origin_z));
    const Point direction = firing.direction.cast<float>();
    const double t = to_seconds(firing.time);
    const auto reach = static_cast<float>(sensor_->max_range);
    const auto middle = world_->cast(sweep, t, origin, direction, reach);
    if (!middle) {
      returns.push_back({});
      continue;
    }
    const auto other = world_->cast(sweep, t, origin, ray_within_beam(*sensor_, direction, random), reach);
    returns.push_back(measure(*sensor_, *middle, other, random));
  }
  return returns;
}

SimulatedBerth::Packet SimulatedBerth::packet(std::uint64_t number) const {
  return encoder_.encode(number, returns(number));
}

HullPose SimulatedBerth::truth(Nanoseconds time) const { return hull_.pose(to_seconds(time)); }
Pose SimulatedBerth::T_W_H(Nanoseconds time) const { return hull_.T_W_H(to_seconds(time)); }
Joints SimulatedBerth::true_joints(Nanoseconds time) const { return loader_.at(to_seconds(time)); }
Nanoseconds SimulatedBerth::plc_cycle(std::int64_t number) const {
  // A microsecond into the cycle: rounding must not fall back into the one before.
  return nanoseconds_from_ms(plc_.cycle_begin(number) * 1e3) + std::chrono::microseconds(1);
}
PlcPresented SimulatedBerth::plc(Nanoseconds time) const { return plc_.at(to_seconds(time)); }

TriangleMesh SimulatedBerth::map_mesh_H() const {
  TriangleMesh mesh;
  append(mesh, ship_mesh(berth_ship()), T_H_ship(berth_ship()));
  return mesh;
}

TriangleMesh SimulatedBerth::hull_mesh_H() const {
  const ShipDesign& ship = scenario_->ship_at_berth;
  TriangleMesh mesh;
  append(mesh, ship_mesh(ship), T_H_ship(ship));
  if (scenario_->cargo_fill > 0.0)
    append(mesh, cargo_mesh(ship, static_cast<float>(scenario_->cargo_fill)), T_H_ship(ship));
  return mesh;
}

Cloud SimulatedBerth::map() const {
  // The loader went along the whole ship with the boom to either side, high and low.
  std::vector<Point> stations_H;
  const LoaderLimits limits = loader_limits();
  constexpr double kStationSpacing = 8.0;  // m of travel
  for (double d_x = limits.travel.low - 12.0; d_x <= limits.travel.high + 12.0; d_x += kStationSpacing)
    for (const double slew : {limits.slew.low, limits.slew.high})
      for (const double luff : {limits.luff.low, limits.luff.high}) {
        const Pose T_W_L = lidar_pose(loader_machine(), {d_x, slew, luff}, sensor_->mount);
        stations_H.push_back(T_W_L.translation().cast<float>());
      }
  return survey(map_mesh_H(), stations_H, options_.seed);
}

LidarConfig SimulatedBerth::lidar_config() const {
  LidarConfig config;
  config.model = sensor_->model;
  config.mount = sensor_->mount;
  config.min_range = sensor_->min_range;
  config.max_range = sensor_->max_range;
  for (const Box& box : own_machine_boxes(sensor_->mount)) {
    const auto edge = [](float metres) { return std::round(static_cast<double>(metres) * 10.0) / 10.0; };
    config.exclude.push_back({edge(box.min.x()), edge(box.min.y()), edge(box.min.z()), edge(box.max.x()),
                              edge(box.max.y()), edge(box.max.z())});
  }
  return config;
}

HullConfig SimulatedBerth::hull_config() const {
  HullConfig config;
  config.reference_point = reference_point_H();
  config.region = Box{{-95.0F, 0.6F, -10.0F}, {95.0F, 45.0F, 25.0F}};
  return config;
}

}  // namespace hulltrack
