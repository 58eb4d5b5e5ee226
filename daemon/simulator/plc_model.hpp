// What does the loader's PLC present at time t? Encoders of finite resolution, latched once a PLC cycle.
//
// Travel is read by a code rail (1 mm), slew and luff by single-turn encoders. A value is as old as the
// encoder's delay plus the time since the cycle began: on average kMeanLatency, which is what a
// configuration states as plc.latency_ms; the rest is jitter of half a cycle either way.
// Seconds from the first firing; m and rad. Pure: any time from any thread.
#pragma once

#include <cstdint>

#include "daemon/simulator/loader_motion.hpp"

namespace hulltrack {

struct EncoderConfig {
  double travel_step = 0.001;  // m
  int slew_bits = 17;          // steps a turn: 2^bits
  int luff_bits = 17;
};

struct PlcPresented {
  Joints joints;
  std::uint16_t heartbeat;  // +1 a cycle
};

class PlcModel {
 public:
  static constexpr double kCycle = 0.011;         // s; not in step with a poll of 20 ms
  static constexpr double kEncoderDelay = 0.003;  // s, measured to latched
  static constexpr double kMeanLatency = kEncoderDelay + 0.5 * kCycle;

  /// `loader` must outlive the model. `seed` sets where in its cycle the PLC is at time 0.
  PlcModel(const LoaderMotion& loader, const EncoderConfig& encoders, std::uint64_t seed);

  [[nodiscard]] PlcPresented at(double t) const;

  /// When cycle `number` begins; may be negative. Its values are presented from then on.
  [[nodiscard]] double cycle_begin(std::int64_t number) const {
    return static_cast<double>(number) * kCycle - phase_;
  }

 private:
  const LoaderMotion* loader_;
  EncoderConfig encoders_;
  double phase_;  // s, in [0, kCycle)
};

}  // namespace hulltrack
