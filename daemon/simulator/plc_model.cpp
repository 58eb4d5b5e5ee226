#include "daemon/simulator/plc_model.hpp"

#include <cmath>
#include <numbers>

#include "daemon/simulator/random.hpp"

namespace hulltrack {
namespace {

double quantised(double value, double step) { return std::round(value / step) * step; }

double encoder_step(int bits) { return 2.0 * std::numbers::pi / std::exp2(bits); }

}  // namespace

PlcModel::PlcModel(const LoaderMotion& loader, const EncoderConfig& encoders, std::uint64_t seed)
    : loader_(&loader), encoders_(encoders), phase_(RandomStream(seed, 300).uniform(0.0, kCycle)) {}

PlcPresented PlcModel::at(double t) const {
  const double cycle = std::floor((t + phase_) / kCycle);
  const Joints true_joints = loader_->at(cycle * kCycle - phase_ - kEncoderDelay);
  const Joints joints{quantised(true_joints.d_x, encoders_.travel_step),
                      quantised(true_joints.theta_r, encoder_step(encoders_.slew_bits)),
                      quantised(true_joints.theta_p, encoder_step(encoders_.luff_bits))};
  const auto count = static_cast<std::int64_t>(cycle);
  return {joints, static_cast<std::uint16_t>(count & 0xFFFF)};
}

}  // namespace hulltrack
