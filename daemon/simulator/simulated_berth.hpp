// One simulation: what the LiDAR sends, what the PLC presents and where the hull really is, at any time.
//
// Time 0 is the first firing of datagram 0; in a recording it stands for kEpoch. Poses as in ICD 1, joints
// in m and rad. Everything is a pure function of (options, datagram number or time): the same options give
// the same bytes on any number of threads, and const calls may come from any thread.
// Failure: create() says what is unknown. Memory: some MB; a datagram of 384 rays takes about 0.5 ms.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/tracking/tracker_config.hpp"
#include "daemon/simulator/berth_world.hpp"
#include "daemon/simulator/dust_plume.hpp"
#include "daemon/simulator/plc_model.hpp"
#include "daemon/simulator/scenario.hpp"
#include "daemon/simulator/sensor_model.hpp"
#include "lidar_drivers/lidar_config.hpp"

namespace hulltrack {

struct SimulationOptions {
  std::string scenario = "berth";
  std::string lidar_model = "velodyne_vlp16";
  std::uint64_t seed = 1;
  int frames = 0;                               // 0 = the scenario's own number; at most kMaxFrames
  std::optional<Joints> parked = std::nullopt;  // the loader stands here and never moves
  std::optional<double> leave_at =
      std::nullopt;  // s: the ship gets under way then, not when the scenario says
  EncoderConfig encoders = {};
  ReturnMode return_mode = ReturnMode::strongest;  // strongest, last or dual
};

/// When does a sensor tell about itself: with its first datagram and once a second from then on.
class InformationTimes {
 public:
  [[nodiscard]] bool due(Nanoseconds time) {
    if (time < next_) return false;
    next_ = time + std::chrono::seconds(1);
    return true;
  }

 private:
  Nanoseconds next_{0};
};

class SimulatedBerth {
 public:
  static constexpr int kMaxFrames = 36'000;  // an hour
  static constexpr Nanoseconds kFramePeriod = std::chrono::milliseconds(100);
  /// 2026-01-01 07:10:00 UTC.
  static constexpr MeasurementTime kEpoch{std::chrono::seconds(1'767'251'400)};
  using Packet = std::vector<std::uint8_t>;

  [[nodiscard]] static Result<std::unique_ptr<SimulatedBerth>> create(const SimulationOptions& options);

  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] const Scenario& scenario() const { return *scenario_; }
  [[nodiscard]] const SensorTraits& sensor() const { return *sensor_; }
  [[nodiscard]] const SimulationOptions& options() const { return options_; }

  /// Datagrams that lie wholly within the first frames() frame periods.
  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  /// Time of the datagram's last firing: when it is sent.
  [[nodiscard]] Nanoseconds sent(std::uint64_t packet) const { return encoder_->last_firing(packet); }
  [[nodiscard]] Packet packet(std::uint64_t number) const;
  /// What the sensor measured for each firing of the datagram, in wire order; range 0 = nothing. With dual
  /// return two a firing, as the encoder wants them.
  [[nodiscard]] std::vector<sim::LaserReturn> returns(std::uint64_t number) const;
  /// What the sensor tells about itself, and the file that goes with it.
  [[nodiscard]] sim::SensorInformation information() const { return encoder_->information(); }
  [[nodiscard]] const sim::LidarEncoder& encoder() const { return *encoder_; }

  /// Where the reference point is and how the hull lies there: of a bent hull the tangent frame at that point
  /// of the ship.
  [[nodiscard]] HullPose truth(Nanoseconds time) const;
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

  /// What a commissioning engineer would have put into the configuration.
  [[nodiscard]] LidarConfig lidar_config() const;
  [[nodiscard]] HullConfig hull_config() const;

 private:
  SimulatedBerth(const SimulationOptions& options, const Scenario& scenario, const SensorTraits& sensor,
                 std::unique_ptr<const sim::LidarEncoder> encoder);

  /// What comes back of one firing from the berth's surfaces, and what of that arrives.
  [[nodiscard]] Echoes surface(const BerthWorld::Sweep& sweep, const sim::LaserFiring& firing,
                               RandomStream& random) const;
  [[nodiscard]] Echoes through_air(const BerthWorld::Sweep& sweep, const DustPlume::Now& dust,
                                   const sim::LaserFiring& firing, Echoes echoes, RandomStream& random) const;

  SimulationOptions options_;
  const Scenario* scenario_;
  const SensorTraits* sensor_;
  int frames_;
  std::unique_ptr<const sim::LidarEncoder> encoder_;
  LoaderMotion loader_;
  HullMotion hull_;
  ShapeChange change_;
  PlcModel plc_;
  DustPlume dust_;
  std::unique_ptr<BerthWorld> world_;
  std::uint64_t packets_ = 0;
};

}  // namespace hulltrack
