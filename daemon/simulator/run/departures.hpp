// In which order do the datagrams of all LiDARs leave, and when?
//
// A sensor tells about itself with its first datagram and once a second from then on; what an unplugged one
// would have sent is left out. Deterministic; nothing fails. The berth must outlive this. Thread rule: one
// owner.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/simulator/run/simulated_berth.hpp"

namespace hulltrack {

struct Departure {
  std::size_t lidar = 0;
  Nanoseconds time{};
  std::optional<std::uint64_t> packet;  // nothing: what the sensor tells about itself
};

class Departures {
 public:
  /// Leaves out datagrams with a firing before `from`.
  explicit Departures(const SimulatedBerth& berth, Nanoseconds from = Nanoseconds{0});

  /// Nothing when the run is over.
  [[nodiscard]] std::optional<Departure> next();
  /// The same up to `count` at a time; empty when the run is over.
  [[nodiscard]] std::vector<Departure> next(std::size_t count);

 private:
  struct Lidar {
    std::uint64_t packet = 0;
    Nanoseconds information_due{0};
    bool informs = false;
  };
  void skip_unplugged(std::size_t lidar);

  const SimulatedBerth* berth_;
  std::vector<Lidar> lidars_;
};

/// The datagram's bytes.
[[nodiscard]] SimulatedBerth::Packet bytes_of(const SimulatedBerth& berth, const Departure& departure);

}  // namespace hulltrack
