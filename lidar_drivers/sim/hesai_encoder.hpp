// The inverse of the Hesai decoder: 0.01 deg of azimuth and one distance unit are what the format resolves.
//
// PandarXT-16, XT-32, XT32M2X and PandarQT, angles as designed, so that no angle correction file is needed.
// Of the XT32M2X lasers 17 to 32 fire together with 1 to 16. The Pandar40P and 64 are not imitated: their
// lasers fire in another order than they stand in the datagram. (0, 1500] rpm, stated as the nearest whole
// one.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack::sim {

class HesaiEncoder final : public LidarEncoder {
 public:
  /// `model` is a hesai_* name of the model registry; one that is unknown or not imitated, or a rate out of
  /// range, is an error.
  [[nodiscard]] static Result<HesaiEncoder> create(std::string_view model, const LidarEncoderConfig& config);

  [[nodiscard]] std::size_t firings_per_packet() const override;
  [[nodiscard]] Nanoseconds packet_interval() const override;
  [[nodiscard]] Nanoseconds packet_duration() const override;
  void firings(std::uint64_t packet, std::vector<LaserFiring>& out) const override;
  [[nodiscard]] std::vector<std::uint8_t> encode(std::uint64_t packet,
                                                 std::span<const LaserReturn> returns) const override;

 private:
  HesaiEncoder(const hesai::ModelTable& model, const LidarEncoderConfig& config);
  [[nodiscard]] std::size_t returns() const;  // a firing
  [[nodiscard]] std::size_t groups() const;   // firings of each laser a datagram
  /// What the azimuth of a group's blocks belongs to.
  [[nodiscard]] Nanoseconds reference(std::uint64_t packet, std::size_t group) const;
  void write_header(std::span<std::uint8_t> bytes) const;
  void write_tail(std::span<std::uint8_t> bytes, std::uint64_t packet) const;

  const hesai::ModelTable* model_;
  LidarEncoderConfig config_;
};

}  // namespace hulltrack::sim
