#include "daemon/simulator/berth/plc_model.hpp"

#include <cmath>
#include <numbers>

#include "daemon/simulator/random.hpp"

namespace hulltrack {
namespace {

double quantised(double value, double step) { return std::round(value / step) * step; }

double encoder_step(int bits) { return 2.0 * std::numbers::pi / std::exp2(bits); }

}  // namespace

PlcModel::PlcModel(const LoaderMotion& loader, const EncoderConfig& encoders, std::uint64_t seed,
                   const Gateway& gateway)
    : loader_(&loader),
      encoders_(encoders),
      seed_(seed),
      gateway_(gateway),
      phase_(RandomStream(seed, 300).uniform(0.0, kCycle)) {}

double PlcModel::presented_from(std::int64_t number) const {
  const double begin = static_cast<double>(number) * kCycle - phase_;
  if (gateway_.delay == 0.0) return begin;
  RandomStream random(seed_, 310, static_cast<std::uint64_t>(number));
  return begin + gateway_.delay + random.uniform(-gateway_.jitter, gateway_.jitter);
}

PlcPresented PlcModel::at(double t) const {
  auto count =
      static_cast<std::int64_t>(std::floor((t - gateway_.delay + gateway_.jitter + phase_) / kCycle));
  if (gateway_.delay > 0.0)
    while (presented_from(count) > t) --count;
  const Joints true_joints = loader_->at(static_cast<double>(count) * kCycle - phase_ - kEncoderDelay);
  const Joints joints{quantised(true_joints.d_x, encoders_.travel_step),
                      quantised(true_joints.theta_r, encoder_step(encoders_.slew_bits)),
                      quantised(true_joints.theta_p, encoder_step(encoders_.luff_bits))};
  return {joints, static_cast<std::uint16_t>(count & 0xFFFF)};
}

}  // namespace hulltrack
