// Random numbers that depend on names, not on order: the same (seed, stream, index) gives the same
// numbers on every machine and for every number of threads.
//
// SplitMix64 (Steele, Lea, Flood 2014) started from a hash of the three. A value type; a few ns a number.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace hulltrack {

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream, std::uint64_t index = 0)
      : state_(mix(mix(mix(seed) + stream) + index)) {}

  [[nodiscard]] std::uint64_t bits() {
    state_ += kStep;
    return mix(state_);
  }
  /// In [0, 1).
  [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box and Muller).
  [[nodiscard]] double gaussian() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15U;
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  std::uint64_t state_;
};

}  // namespace hulltrack
