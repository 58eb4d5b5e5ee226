// One simulation: what the LiDARs send, what the PLC presents and where the hull really is, at any time.
//
// Time 0 is the first firing of every LiDAR; in a recording it stands for kEpoch. Poses as in ICD 1, joints
// in m and rad. Everything is a pure function of (options, datagram number or time): the same options give
// the same bytes on any number of threads, and const calls may come from any thread.
// Failure: create() says what is unknown. Memory: some MB.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/tracking/tracker_config.hpp"
#include "daemon/simulator/berth/berth_world.hpp"
#include "daemon/simulator/berth/dust_plume.hpp"
#include "daemon/simulator/berth/plc_model.hpp"
#include "daemon/simulator/run/scenario.hpp"
#include "daemon/simulator/run/simulated_lidar.hpp"
#include "daemon/simulator/spells.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack {

/// One of several LiDARs that sends nothing for a while.
struct Unplugged {
  std::size_t lidar = 0;  // of SimulationOptions::lidar_models
  Spells when = {};
};

struct SimulationOptions {
  std::string scenario = "berth";
  std::vector<std::string> lidar_models = {"velodyne_vlp16"};  // one for each bracket that is in use
  std::optional<Unplugged> unplugged = std::nullopt;
  std::uint64_t seed = 1;
  int frames = 0;                               // 0 = the scenario's own number; at most kMaxFrames
  std::optional<Joints> parked = std::nullopt;  // the loader stands here and never moves
  std::optional<double> leave_at =
      std::nullopt;  // s: the ship gets under way then, not when the scenario says
  EncoderConfig encoders = {};
  ReturnMode return_mode = ReturnMode::strongest;  // strongest, last or dual
  bool configure_quay_map = true;                  // the configuration names the map of the quay
};

class SimulatedBerth {
 public:
  static constexpr int kMaxFrames = 36'000;  // an hour
  static constexpr Nanoseconds kFramePeriod = std::chrono::milliseconds(100);
  /// 2026-01-01 07:10:00 UTC.
  static constexpr MeasurementTime kEpoch{std::chrono::seconds(1'767'251'400)};
  using Packet = SimulatedLidar::Packet;

  [[nodiscard]] static Result<std::unique_ptr<SimulatedBerth>> create(const SimulationOptions& options);

  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] const Scenario& scenario() const { return *scenario_; }
  [[nodiscard]] const SimulationOptions& options() const { return options_; }

  /// At least one. The first one's window is what a scenario covers.
  [[nodiscard]] const std::vector<SimulatedLidar>& lidars() const { return lidars_; }
  /// Is nothing wrong with the LiDAR's cable?
  [[nodiscard]] bool plugged_in(std::size_t lidar, Nanoseconds time) const;

  /// Where the reference point is and how the hull lies there: of a bent hull the tangent frame at that point
  /// of the ship.
  [[nodiscard]] ShipPose truth(Nanoseconds time) const;
  /// How much the hull is bent since the map was made, see hull_shape.hpp; m.
  [[nodiscard]] double bend(Nanoseconds time) const;
  /// Of the hull as if it were not bent: where hull_mesh_H lies.
  [[nodiscard]] Pose T_W_H(Nanoseconds time) const;
  [[nodiscard]] const HullMotion& hull() const { return hull_; }
  [[nodiscard]] Joints true_joints(Nanoseconds time) const;
  [[nodiscard]] PlcPresented plc(Nanoseconds time) const;
  [[nodiscard]] const PlcModel& plc_model() const { return plc_; }
  /// When the values of the PLC's cycle `number` can be read.
  [[nodiscard]] Nanoseconds plc_cycle(std::int64_t number) const;
  [[nodiscard]] const BerthWorld& world() const { return *world_; }

  /// The ship of the map in H, empty; and the ship that really lies there, with its cargo and bend.
  [[nodiscard]] TriangleMesh map_mesh_H() const;
  [[nodiscard]] TriangleMesh hull_mesh_H(Nanoseconds time = Nanoseconds{0}) const;
  [[nodiscard]] Cloud map() const;
  /// What is built at the berth, and what was parked there, in W, surveyed while no ship lay there.
  [[nodiscard]] Cloud quay_map() const;

  /// What a commissioning engineer would have put into the configuration: names and files that differ.
  [[nodiscard]] LidarConfig lidar_config(std::size_t lidar) const;
  [[nodiscard]] std::vector<LidarConfig> lidar_configs() const;
  [[nodiscard]] HullConfig hull_config() const;

 private:
  using Encoder = std::unique_ptr<const sim::LidarEncoder>;
  SimulatedBerth(const SimulationOptions& options, const Scenario& scenario, std::vector<Encoder> encoders);

  SimulationOptions options_;
  const Scenario* scenario_;
  int frames_;
  LoaderMotion loader_;
  HullMotion hull_;
  ShapeChange change_;
  PlcModel plc_;
  DustPlume dust_;
  std::unique_ptr<BerthWorld> world_;
  std::vector<SimulatedLidar> lidars_;
};

}  // namespace hulltrack
