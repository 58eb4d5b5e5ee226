// What does the loader's PLC present at time t? Encoders of finite resolution, latched once a PLC cycle.
//
// Travel is read by a code rail (1 mm), slew and luff by single-turn encoders. A value is as old as the
// encoder's delay plus the time since the cycle began, plus what a gateway between the PLC and us takes: on
// average mean_latency(), which is what a configuration states as plc.latency_ms; the rest is jitter of half
// a cycle either way and the gateway's own. Seconds from the first firing; m and rad. Pure: any time from any
// thread.
#pragma once

#include <cstdint>

#include "daemon/simulator/berth/loader_motion.hpp"

namespace hulltrack {

struct EncoderConfig {
  double travel_step = 0.001;  // m
  int slew_bits = 17;          // steps a turn: 2^bits
  int luff_bits = 17;
};

/// Values of a PLC cycle are to be read this much after the cycle began, the same for all of them up to
/// `jitter` either way. Precondition: jitter less than half a cycle, so that none overtakes another.
struct Gateway {
  double delay = 0.0;   // s
  double jitter = 0.0;  // s
};

struct PlcPresented {
  Joints joints;
  std::uint16_t heartbeat;  // +1 a cycle
};

class PlcModel {
 public:
  static constexpr double kCycle = 0.011;         // s; not in step with a poll of 20 ms
  static constexpr double kEncoderDelay = 0.003;  // s, measured to latched

  /// `loader` must outlive the model. `seed` sets where in its cycle the PLC is at time 0.
  PlcModel(const LoaderMotion& loader, const EncoderConfig& encoders, std::uint64_t seed,
           const Gateway& gateway = {});

  [[nodiscard]] double mean_latency() const { return kEncoderDelay + 0.5 * kCycle + gateway_.delay; }
  [[nodiscard]] PlcPresented at(double t) const;

  /// From when on the values of cycle `number` are presented; it may be negative.
  [[nodiscard]] double presented_from(std::int64_t number) const;
  [[nodiscard]] const Gateway& gateway() const { return gateway_; }

 private:
  const LoaderMotion* loader_;
  EncoderConfig encoders_;
  std::uint64_t seed_;
  Gateway gateway_;
  double phase_;  // s, in [0, kCycle)
};

}  // namespace hulltrack
