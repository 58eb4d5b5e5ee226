// A LiDAR on the bench: its datagrams in order, with what was really fired.
//
// Ranges follow a fixed pattern of the firing, so that any two returns differ.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "lidar_drivers/datagram.hpp"
#include "lidar_drivers/sim/encoder_registry.hpp"

namespace hulltrack::test {

struct StreamPacket {
  std::vector<std::uint8_t> bytes;
  MeasurementTime last_firing;

  [[nodiscard]] Datagram datagram() const {
    Datagram d;
    d.bytes = bytes;
    d.received = last_firing;
    d.received_utc = WallTime{last_firing.time_since_epoch()};
    d.destination_port = 2368;
    return d;
  }
};

/// A return as it was fired: where, when.
struct TrueReturn {
  Eigen::Vector3d point;  // m, in L
  MeasurementTime time;
  std::uint8_t channel = 0;
  std::uint8_t intensity = 0;
  double range = 0.0;  // m
};

struct LidarStream {
  std::vector<StreamPacket> packets;
  std::vector<TrueReturn> returns;  // in wire order
};

struct StreamOptions {
  std::string model = "velodyne_vlp16";
  std::size_t slots = 32;  // returns in a block of the model's
  sim::LidarEncoderConfig encoder = {};
  MeasurementTime start = measurement_time_from_ns(1'700'000'000'000'000'000);
  std::size_t packets = 100;
  unsigned seed = 1;
};

inline LidarStream make_stream(const StreamOptions& options) {
  const auto created = sim::make_lidar_encoder(options.model, options.encoder);
  const sim::LidarEncoder& encoder = *created.value();
  const bool dual = options.encoder.return_mode == ReturnMode::dual;
  std::mt19937 random(options.seed);
  std::uniform_int_distribution<int> range_mm(500, 90'000);
  std::uniform_int_distribution<int> intensity(0, 255);
  std::uniform_int_distribution<int> percent(0, 99);
  LidarStream stream;
  std::vector<sim::LaserFiring> firings;
  for (std::uint64_t n = 0; n < options.packets; ++n) {
    encoder.firings(n, firings);
    std::vector<sim::LaserReturn> returns;
    for (std::size_t i = 0; i < firings.size(); ++i) {
      const bool hit = percent(random) < 80;
      const sim::LaserReturn last{hit ? range_mm(random) * 1e-3 : 0.0,
                                  static_cast<std::uint8_t>(intensity(random))};
      returns.push_back(last);
      if (!dual) continue;
      const bool one_echo = percent(random) < 70;
      returns.push_back(one_echo ? last : sim::LaserReturn{last.range / 2.0, last.intensity});
    }
    const auto bytes = encoder.encode(n, returns);
    stream.packets.push_back({{bytes.begin(), bytes.end()}, options.start + encoder.last_firing(n)});
    const std::size_t echoes = dual ? 2 : 1;
    for (std::size_t group = 0; group < firings.size(); group += options.slots) {
      for (std::size_t echo = 0; echo < echoes; ++echo) {
        for (std::size_t slot = 0; slot < options.slots; ++slot) {
          const sim::LaserFiring& firing = firings[group + slot];
          const sim::LaserReturn& hit = returns[(group + slot) * echoes + echo];
          if (hit.range == 0.0) continue;
          stream.returns.push_back({firing.origin + hit.range * firing.direction, options.start + firing.time,
                                    firing.channel, hit.intensity, hit.range});
        }
      }
    }
  }
  return stream;
}

}  // namespace hulltrack::test
