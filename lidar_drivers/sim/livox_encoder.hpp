// The inverse of the Livox decoder: a Mid-360 that scans 360 x 59 deg and never the same way twice.
//
// Data type 1 (x, y, z in mm), 96 shots 5 us apart in a datagram, stamps of a PTP clock. The four lasers
// share a mirror that turns about z while it nods; the two rates have no common measure, so the pattern fills
// the field of view with time: elevation -7 to 52 deg, all azimuths. Only the turning follows the maker's
// figures in so far as 0.1 s sees the whole field. rpm is not looked at; start_azimuth is the mirror's at
// time 0. Return mode: strongest.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.hpp"
#include "lidar_drivers/sim/lidar_encoder.hpp"

namespace hulltrack::sim {

class LivoxEncoder final : public LidarEncoder {
 public:
  /// `model` is "livox_mid360"; another one, or another return mode, is an error.
  [[nodiscard]] static Result<LivoxEncoder> create(std::string_view model, const LidarEncoderConfig& config);

  [[nodiscard]] std::size_t firings_per_packet() const override;
  [[nodiscard]] Nanoseconds packet_interval() const override;
  [[nodiscard]] Nanoseconds packet_duration() const override;
  void firings(std::uint64_t packet, std::vector<LaserFiring>& out) const override;
  [[nodiscard]] std::vector<std::uint8_t> encode(std::uint64_t packet,
                                                 std::span<const LaserReturn> returns) const override;

 private:
  explicit LivoxEncoder(const LidarEncoderConfig& config) : config_(config) {}
  [[nodiscard]] LaserFiring firing(std::uint64_t packet, std::size_t shot) const;

  LidarEncoderConfig config_;
};

}  // namespace hulltrack::sim
