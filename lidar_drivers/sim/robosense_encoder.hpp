// The inverse of the RoboSense decoder: 0.01 deg of azimuth (which it truncates) and one distance unit are
// what the format resolves. 384 firings a datagram, with two returns 192. (0, 1500] rpm.
//
// The unit it plays has lasers at evenly spaced elevations, a table of no real unit's; information() tells
// it. Not the RS-LiDAR-32 and the Bpearl: their wire order is not the order of firing.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "lidar_drivers/robosense/robosense_difop.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack::sim {

class RobosenseEncoder final : public LidarEncoder {
 public:
  /// `model` is a robosense_* name of the model registry; one that cannot be played, or a rate out of range,
  /// is an error.
  [[nodiscard]] static Result<RobosenseEncoder> create(std::string_view model,
                                                       const LidarEncoderConfig& config);

  [[nodiscard]] std::size_t firings_per_packet() const override;
  [[nodiscard]] Nanoseconds packet_interval() const override;
  [[nodiscard]] Nanoseconds packet_duration() const override;
  void firings(std::uint64_t packet, std::vector<LaserFiring>& out) const override;
  [[nodiscard]] std::vector<std::uint8_t> encode(std::uint64_t packet,
                                                 std::span<const LaserReturn> returns) const override;
  [[nodiscard]] SensorInformation information() const override;

 private:
  RobosenseEncoder(const robosense::ModelTable& model, const LidarEncoderConfig& config);
  [[nodiscard]] bool dual() const { return config_.return_mode == ReturnMode::dual; }
  [[nodiscard]] int blocks_per_firing() const;  // 2: a pair of blocks holds one firing's two echoes
  [[nodiscard]] int firings_per_block() const;  // of all lasers

  const robosense::ModelTable* model_;
  LidarEncoderConfig config_;
  std::array<robosense::LaserAngles, robosense::kSlots> angles_{};
};

}  // namespace hulltrack::sim
