// One LiDAR of the simulation: which datagrams it sends, and what it measured for each of their firings.
//
// Time 0 is the first firing of datagram 0. Everything is a pure function of (setup, datagram number): const
// calls may come from any thread. Nothing fails. A datagram of 384 rays takes about 0.5 ms.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "daemon/simulator/berth/berth_world.hpp"
#include "daemon/simulator/berth/dust_plume.hpp"
#include "daemon/simulator/run/scenario.hpp"
#include "daemon/simulator/sensing/sensor_model.hpp"
#include "lidar_drivers/lidar_config.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack {

/// What is around the sensor. All of it must outlive the LiDAR.
struct LidarSurroundings {
  const BerthWorld& world;
  const DustPlume& dust;
  const Weather& weather;
  const WindowCover& cover;
};

class SimulatedLidar {
 public:
  using Packet = std::vector<std::uint8_t>;

  struct Setup {
    std::size_t bracket;  // of lidar_brackets(); also which of the random numbers are this LiDAR's
    const SensorTraits* sensor;
    std::unique_ptr<const sim::LidarEncoder> encoder;
    ReturnMode return_mode;  // the encoder's
    std::uint64_t seed;
  };

  /// Sends the datagrams that lie wholly between time 0 and `end`.
  SimulatedLidar(Setup setup, const LidarSurroundings& around, Nanoseconds end);

  [[nodiscard]] const SensorTraits& sensor() const { return *setup_.sensor; }
  [[nodiscard]] const sim::LidarEncoder& encoder() const { return *setup_.encoder; }
  [[nodiscard]] const Pose& mount() const { return mount_; }

  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  /// Time of the datagram's last firing: when it is sent.
  [[nodiscard]] Nanoseconds sent(std::uint64_t packet) const { return setup_.encoder->last_firing(packet); }
  [[nodiscard]] Packet packet(std::uint64_t number) const;
  /// What the sensor measured for each firing of the datagram, in wire order; range 0 = nothing. With dual
  /// return two a firing, as the encoder wants them.
  [[nodiscard]] std::vector<sim::LaserReturn> returns(std::uint64_t number) const;
  /// What the sensor tells about itself, and the file that goes with it.
  [[nodiscard]] sim::SensorInformation information() const { return setup_.encoder->information(); }

  /// What a commissioning engineer would have put into the configuration: a sensor as delivered, alone on its
  /// ports.
  [[nodiscard]] LidarConfig config() const;

 private:
  /// What comes back of one firing from the berth's surfaces, and what of that arrives.
  [[nodiscard]] Echoes surface(const BerthWorld::Sweep& sweep, const sim::LaserFiring& firing,
                               RandomStream& random) const;
  [[nodiscard]] Echoes through_air(const BerthWorld::Sweep& sweep, const DustPlume::Now& dust,
                                   const sim::LaserFiring& firing, Echoes echoes, RandomStream& random) const;

  Setup setup_;
  LidarSurroundings around_;
  Pose mount_;
  std::uint64_t packets_ = 0;
};

}  // namespace hulltrack
