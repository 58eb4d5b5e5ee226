#include "lidar_drivers/rotor.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace hulltrack::rotor {

namespace {

constexpr int kMaxBackwardStep = 10;
constexpr double kMinStepTolerance = 3.0;

}  // namespace

int forward_step(int from, int to) {
  const int step = (to - from + kCentidegrees) % kCentidegrees;
  return step >= kCentidegrees - kMaxBackwardStep ? step - kCentidegrees : step;
}

std::optional<double> fit_steps(std::span<const int> steps, double expected, std::span<bool> jump) {
  assert(jump.size() >= steps.size());
  const double tolerance = std::max(kMinStepTolerance, expected / 2.0);
  int fitting = 0;
  int sum = 0;
  for (std::size_t g = 0; g < steps.size(); ++g) {
    jump[g] = std::abs(steps[g] - expected) > tolerance;
    if (jump[g]) continue;
    ++fitting;
    sum += steps[g];
  }
  if (fitting == 0) return std::nullopt;
  return std::max(0.0, static_cast<double>(sum) / fitting);
}

Nanoseconds duration_of(int step, bool jump, double rate, bool rate_known, Nanoseconds period) {
  const double periods = jump && rate_known ? std::max(1.0, step / rate) : 1.0;
  return Nanoseconds(std::llround(periods * static_cast<double>(period.count())));
}

std::optional<Nanoseconds> time_to_zero(double azimuth, double step, Nanoseconds span) {
  if (step <= 0.0 || azimuth + step < kCentidegrees) return std::nullopt;
  const double share = (kCentidegrees - azimuth) / step;
  return Nanoseconds(std::llround(share * static_cast<double>(span.count())));
}

}  // namespace hulltrack::rotor
