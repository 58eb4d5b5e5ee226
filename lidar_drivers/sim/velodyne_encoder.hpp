// The inverse of the Velodyne decoder: 0.01 deg of azimuth and one distance unit are what the format
// resolves. 384 firings a datagram with a single return, 192 with two. (0, 1500] rpm.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"
#include "lidar_drivers/velodyne/velodyne_format.hpp"

namespace hulltrack::sim {

class VelodyneEncoder final : public LidarEncoder {
 public:
  /// `model` is a velodyne_* name of the model registry; an unknown one, or a rate out of range, is an error.
  [[nodiscard]] static Result<VelodyneEncoder> create(std::string_view model,
                                                      const LidarEncoderConfig& config);

  [[nodiscard]] std::size_t firings_per_packet() const override;
  [[nodiscard]] Nanoseconds packet_interval() const override;
  [[nodiscard]] Nanoseconds packet_duration() const override;
  void firings(std::uint64_t packet, std::vector<LaserFiring>& out) const override;
  [[nodiscard]] std::vector<std::uint8_t> encode(std::uint64_t packet,
                                                 std::span<const LaserReturn> returns) const override;

 private:
  VelodyneEncoder(const velodyne::ModelTable& model, const LidarEncoderConfig& config);
  [[nodiscard]] int groups() const;  // firing groups a datagram: 12, dual 6

  const velodyne::ModelTable* model_;
  LidarEncoderConfig config_;
};

}  // namespace hulltrack::sim
