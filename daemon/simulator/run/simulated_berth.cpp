#include "daemon/simulator/run/simulated_berth.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/simulator/berth/berth_mesh.hpp"
#include "daemon/simulator/berth/loader_machine.hpp"
#include "daemon/simulator/berth/quay_traffic.hpp"
#include "daemon/simulator/berth/survey.hpp"
#include "daemon/simulator/ship/ship_mesh.hpp"
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
  const std::size_t brackets = lidar_brackets().size();
  if (options.lidar_models.empty() || options.lidar_models.size() > brackets)
    return Error{"the boom has brackets for 1 to " + std::to_string(brackets) + " LiDARs"};
  if (options.unplugged && options.unplugged->lidar >= options.lidar_models.size())
    return Error{"there is no LiDAR " + std::to_string(options.unplugged->lidar + 1) + " to unplug"};
  if (options.frames < 0 || options.frames > kMaxFrames)
    return Error{"the number of frames must lie between 1 and " + std::to_string(kMaxFrames)};
  if (options.leave_at && !under_way(scenario->motion))
    return Error{"the ship of scenario \"" + options.scenario +
                 "\" never gets under way: leave out the time to leave"};
  std::vector<Encoder> encoders;
  for (const std::string& model : options.lidar_models) {
    if (find_sensor(model) == nullptr)
      return Error{"cannot simulate LiDAR model \"" + model + "\"; can simulate " + known_names(true)};
    RandomStream random(options.seed, 500 + encoders.size());
    sim::LidarEncoderConfig config;
    config.return_mode = options.return_mode;
    config.rpm = kRpm;
    config.start_azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
    config.utc = kEpoch.time_since_epoch();
    auto encoder = sim::make_lidar_encoder(model, config);
    if (!encoder) return encoder.error();
    encoders.push_back(std::move(*encoder));
  }
  return std::unique_ptr<SimulatedBerth>(new SimulatedBerth(options, *scenario, std::move(encoders)));
}

SimulatedBerth::SimulatedBerth(const SimulationOptions& options, const Scenario& scenario,
                               std::vector<Encoder> encoders)
    : options_(options),
      scenario_(&scenario),
      frames_(options.frames > 0 ? options.frames : scenario.frames),
      loader_(loader_motion(options, scenario, to_seconds(frames_ * kFramePeriod))),
      hull_(hull_motion(options, scenario), reference_point_H(), options.seed),
      change_(shape_change(scenario)),
      plc_(loader_, options.encoders, options.seed, scenario.gateway),
      dust_(scenario.dust, loader_, options.seed),
      world_(std::make_unique<BerthWorld>(shaped_meshes_H(scenario.ship_at_berth, change_), change_, loader_,
                                          hull_, scenario.crane, options.seed)) {
  static const WindowCover open;
  for (std::size_t i = 0; i < encoders.size(); ++i) {
    const WindowCover& cover = i == 0 ? scenario.cover : open;
    lidars_.emplace_back(SimulatedLidar::Setup{i, find_sensor(options.lidar_models[i]),
                                               std::move(encoders[i]), options.return_mode, options.seed},
                         LidarSurroundings{*world_, dust_, scenario.weather, cover}, frames_ * kFramePeriod);
  }
}

bool SimulatedBerth::plugged_in(std::size_t lidar, Nanoseconds time) const {
  const auto& unplugged = options_.unplugged;
  return !unplugged || unplugged->lidar != lidar || !unplugged->when.active(to_seconds(time));
}

ShipPose SimulatedBerth::truth(Nanoseconds time) const {
  const double t = to_seconds(time);
  const ShipPose straight = hull_.pose(t);
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

namespace {

/// The loader went along the whole berth with the boom to either side, high and low. In W.
std::vector<Point> survey_stations() {
  std::vector<Point> stations;
  const LoaderLimits limits = loader_limits();
  constexpr double kStationSpacing = 8.0;  // m of travel
  for (double d_x = limits.travel.low - 12.0; d_x <= limits.travel.high + 12.0; d_x += kStationSpacing)
    for (const double slew : {limits.slew.low, limits.slew.high})
      for (const double luff : {limits.luff.low, limits.luff.high}) {
        const Pose T_W_L = lidar_pose(loader_machine(), {d_x, slew, luff}, lidar_brackets().front());
        stations.push_back(T_W_L.translation().cast<float>());
      }
  return stations;
}

}  // namespace

// When the hull was surveyed, H was W.
Cloud SimulatedBerth::map() const { return survey(map_mesh_H(), survey_stations(), options_.seed); }

Cloud SimulatedBerth::quay_map() const {
  TriangleMesh then = berth_mesh();
  append(then, parked_at_survey(options_.seed), Pose::Identity());
  Cloud map = survey(then, survey_stations(), options_.seed, kQuayVoxel);
  constexpr float kSplash = 0.3F;  // m: the quay's wall is wet up to here
  std::erase_if(map, [](const Point& p) { return p.z() < kWaterLevel + kSplash; });
  return map;
}

LidarConfig SimulatedBerth::lidar_config(std::size_t lidar) const {
  LidarConfig config = lidars_[lidar].config();
  config.name = "boom";
  if (lidar == 0) return config;
  config.name += std::to_string(lidar + 1);
  if (!config.calibration.empty()) config.calibration = config.name + "_" + config.calibration;
  return config;
}

std::vector<LidarConfig> SimulatedBerth::lidar_configs() const {
  std::vector<LidarConfig> configs;
  for (std::size_t i = 0; i < lidars_.size(); ++i) configs.push_back(lidar_config(i));
  return configs;
}

HullConfig SimulatedBerth::hull_config() const {
  HullConfig config;
  config.reference_point = reference_point_H();
  config.envelope = Box{{-10.0F, -2.0F, -9.0F}, {10.0F, 2.0F, 3.0F}};
  config.region = Box{{-95.0F, 0.6F, -10.0F}, {95.0F, 45.0F, 25.0F}};
  return config;
}

}  // namespace hulltrack
