#include "daemon/simulator/simulated_berth.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/simulator/berth_mesh.hpp"
#include "daemon/simulator/loader_machine.hpp"
#include "daemon/simulator/ship_mesh.hpp"
#include "daemon/simulator/survey.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/sim/encoder_registry.hpp"

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
  const auto start = under_way(motion);
  if (!options.leave_at || !start) return motion;
  for (Course& course : motion.courses) course.run.start = *options.leave_at + (course.run.start - *start);
  return motion;
}

LoaderMotion loader_motion(const SimulationOptions& options, const Scenario& scenario, double duration) {
  return options.parked ? LoaderMotion(*options.parked)
                        : LoaderMotion(scenario.loader, duration, options.seed);
}

ShapeChange shape_change(const Scenario& scenario) {
  return {scenario.at_first, scenario.at_last, to_seconds(scenario.frames * SimulatedBerth::kFramePeriod)};
}

TriangleMesh in_H(const TriangleMesh& ship_mesh, const ShipDesign& ship) {
  TriangleMesh mesh;
  append(mesh, ship_mesh, T_H_ship(ship));
  return mesh;
}

/// The ship in her place of when the map was made, loaded and bent.
TriangleMesh shaped_mesh_H(const ShipDesign& ship, const HullShape& shape) {
  TriangleMesh mesh = in_H(ship_mesh(ship), ship);
  if (shape.fill > 0.0) append(mesh, cargo_mesh(ship, static_cast<float>(shape.fill)), T_H_ship(ship));
  return shape.bend == 0.0 ? mesh : bent(mesh, shape.bend, static_cast<double>(ship.length));
}

std::vector<TriangleMesh> shaped_meshes_H(const ShipDesign& ship, const ShapeChange& change) {
  std::vector<TriangleMesh> meshes;
  for (std::size_t i = 0; i < change.shapes(); ++i) meshes.push_back(shaped_mesh_H(ship, change.shape(i)));
  return meshes;
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
  if (options.leave_at && !under_way(scenario->motion))
    return Error{"the ship of scenario \"" + options.scenario +
                 "\" never gets under way: leave out the time to leave"};
  RandomStream random(options.seed, 500);
  sim::LidarEncoderConfig config;
  config.return_mode = options.return_mode;
  config.rpm = kRpm;
  config.start_azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
  config.utc = kEpoch.time_since_epoch();
  auto encoder = sim::make_lidar_encoder(sensor->model, config);
  if (!encoder) return encoder.error();
  return std::unique_ptr<SimulatedBerth>(
      new SimulatedBerth(options, *scenario, *sensor, std::move(*encoder)));
}

SimulatedBerth::SimulatedBerth(const SimulationOptions& options, const Scenario& scenario,
                               const SensorTraits& sensor, std::unique_ptr<const sim::LidarEncoder> encoder)
    : options_(options),
      scenario_(&scenario),
      sensor_(&sensor),
      frames_(options.frames > 0 ? options.frames : scenario.frames),
      encoder_(std::move(encoder)),
      loader_(loader_motion(options, scenario, to_seconds(frames_ * kFramePeriod))),
      hull_(hull_motion(options, scenario), reference_point_H(), options.seed),
      change_(shape_change(scenario)),
      plc_(loader_, options.encoders, options.seed, scenario.gateway),
      dust_(scenario.dust, loader_, options.seed),
      world_(std::make_unique<BerthWorld>(shaped_meshes_H(scenario.ship_at_berth, change_), change_, loader_,
                                          hull_, sensor.mount, scenario.crane)) {
  const Nanoseconds end = frames_ * kFramePeriod;
  packets_ = static_cast<std::uint64_t>(end / encoder_->packet_interval());
  while (packets_ > 0 && encoder_->last_firing(packets_ - 1) >= end) --packets_;
}

std::vector<sim::LaserReturn> SimulatedBerth::returns(std::uint64_t number) const {
  std::vector<sim::LaserFiring> firings;
  encoder_->firings(number, firings);
  const auto sweep = world_->sweep(to_seconds(firings.front().time), to_seconds(firings.back().time));
  const DustPlume::Now dust = dust_.at(sweep.begin);
  RandomStream random(options_.seed, 600, number);
  RandomStream air_random(options_.seed, 610, number);
  std::vector<sim::LaserReturn> returns;
  returns.reserve(2 * firings.size());
  for (const sim::LaserFiring& firing : firings) {
    const Echoes echoes = scenario_->cover.hides(to_seconds(firing.time), firing.azimuth)
                              ? behind_cover(air_random)
                              : through_air(sweep, dust, firing, surface(sweep, firing, random), air_random);
    switch (options_.return_mode) {
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

Echoes SimulatedBerth::surface(const BerthWorld::Sweep& sweep, const sim::LaserFiring& firing,
                               RandomStream& random) const {
  const Point origin = firing.origin.cast<float>();
  const Point direction = firing.direction.cast<float>();
  const double t = to_seconds(firing.time);
  const auto reach = static_cast<float>(sensor_->max_range);
  const auto middle = world_->cast(sweep, t, origin, direction, reach);
  if (!middle) return {};
  const auto other = world_->cast(sweep, t, origin, ray_within_beam(*sensor_, direction, random), reach);
  return measure(*sensor_, *middle, other, random);
}

Echoes SimulatedBerth::through_air(const BerthWorld::Sweep& sweep, const DustPlume::Now& dust,
                                   const sim::LaserFiring& firing, Echoes echoes,
                                   RandomStream& random) const {
  const double t = to_seconds(firing.time);
  if (scenario_->dust > 0.0) {
    const Point origin = firing.origin.cast<float>();
    const auto [origin_W, direction_W] = BerthWorld::ray_W(sweep, t, origin, firing.direction.cast<float>());
    const double reach = echoes.first.range > 0.0 ? echoes.first.range : sensor_->max_range;
    if (const auto at = dust_.stops(dust, origin_W, direction_W, static_cast<float>(reach), random))
      echoes = behind_particle(static_cast<double>(*at), echoes, random);
  }
  if (scenario_->weather.when.active(t))
    echoes = through_weather(scenario_->weather, *sensor_, echoes, random);
  return echoes;
}

SimulatedBerth::Packet SimulatedBerth::packet(std::uint64_t number) const {
  return encoder_->encode(number, returns(number));
}

HullPose SimulatedBerth::truth(Nanoseconds time) const {
  const double t = to_seconds(time);
  const HullPose straight = hull_.pose(t);
  const double bend = this->bend(time);
  if (bend == 0.0) return straight;
  const double length = static_cast<double>(scenario_->ship_at_berth.length);
  const Eigen::Vector3d& p_H = hull_.reference_point();
  const Eigen::Vector3d moved_H(p_H.x(), p_H.y(), p_H.z() + deflection(bend, length, p_H.x()));
  const double bow_up = std::atan(deflection_slope(bend, length, p_H.x()));
  const Pose T = hull_.T_W_H(t);
  return {T * moved_H - p_H, rpy_from_rotation(T.linear() * rotation_from_rpy({0.0, -bow_up, 0.0}))};
}

double SimulatedBerth::bend(Nanoseconds time) const {
  return change_.shape(change_.at(to_seconds(time))).bend;
}

Pose SimulatedBerth::T_W_H(Nanoseconds time) const { return hull_.T_W_H(to_seconds(time)); }
Joints SimulatedBerth::true_joints(Nanoseconds time) const { return loader_.at(to_seconds(time)); }
Nanoseconds SimulatedBerth::plc_cycle(std::int64_t number) const {
  // A microsecond later: rounding must not fall back into the one before.
  return nanoseconds_from_ms(plc_.presented_from(number) * 1e3) + std::chrono::microseconds(1);
}
PlcPresented SimulatedBerth::plc(Nanoseconds time) const { return plc_.at(to_seconds(time)); }

TriangleMesh SimulatedBerth::map_mesh_H() const { return in_H(ship_mesh(berth_ship()), berth_ship()); }

TriangleMesh SimulatedBerth::hull_mesh_H(Nanoseconds time) const {
  return shaped_mesh_H(scenario_->ship_at_berth, change_.shape(change_.at(to_seconds(time))));
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
  if (const LidarModel* model = find_lidar_model(config.model)) {
    config.port = model->port;
    config.information_port = model->information_port;
  }
  config.calibration = information().calibration_name;
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
  config.envelope = Box{{-10.0F, -2.0F, -9.0F}, {10.0F, 2.0F, 3.0F}};
  config.region = Box{{-95.0F, 0.6F, -10.0F}, {95.0F, 45.0F, 25.0F}};
  return config;
}

}  // namespace hulltrack
