#include "lidar_drivers/hesai/hesai_rotation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/geometry/se3.hpp"

namespace hulltrack::hesai {

namespace {

/// A turn slower than any model's lowest setting (300 rpm) tells nothing about how long a jump took.
constexpr double kMinRpmToTimeJumps = 200.0;
/// Azimuth may come back by this much when the rotor stands still, 0.01 deg.
constexpr int kMaxBackwardStep = 10;
/// A step this far from the usual one is still the same rotation, 0.01 deg.
constexpr double kMinStepTolerance = 3.0;

int forward_step(int from, int to) {
  const int step = (to - from + kCentidegrees) % kCentidegrees;
  return step >= kCentidegrees - kMaxBackwardStep ? step - kCentidegrees : step;
}

/// Steps are rounded to 1, and a motor holds its speed to a few hundredths.
bool agree(double motor_step, double seen_step) {
  return std::abs(motor_step - seen_step) <= 1.0 + 0.05 * seen_step;
}

}  // namespace

double Rotation::rate() const { return radians(step * 0.01) / to_seconds(period); }

double Rotation::azimuth_at(std::size_t group, Nanoseconds after) const {
  const double turned = radians(azimuth[group] * 0.01) + rate() * to_seconds(after);
  const double within = std::fmod(turned, 2.0 * std::numbers::pi);
  return within < 0.0 ? within + 2.0 * std::numbers::pi : within;
}

std::optional<double> Rotation::cut_azimuth() const {
  for (std::size_t g = groups - 1; g-- > 0;) {
    if (jump[g]) return radians(azimuth[g] * 0.01);
  }
  return std::nullopt;
}

std::optional<Nanoseconds> Rotation::zero_crossing(Nanoseconds first, Nanoseconds last) const {
  const auto crossing = [&](double from, double ahead, Nanoseconds at,
                            Nanoseconds span) -> std::optional<Nanoseconds> {
    if (ahead <= 0.0 || from + ahead < kCentidegrees) return std::nullopt;
    const double share = (kCentidegrees - from) / ahead;
    const Nanoseconds found = at + Nanoseconds(std::llround(share * static_cast<double>(span.count())));
    if (found < first || found > last) return std::nullopt;
    return found;
  };
  // Before the first reference and after the last one the rotor goes on evenly.
  if (const auto found =
          crossing(azimuth[0] - step + (azimuth[0] < step ? kCentidegrees : 0), step, -period, period))
    return found;
  for (std::size_t g = 0; g < groups; ++g) {
    const bool has_next = g + 1 < groups;
    const double ahead = has_next ? forward_step(azimuth[g], azimuth[g + 1]) : step;
    const Nanoseconds span = has_next ? time[g + 1] - time[g] : period;
    if (const auto found = crossing(azimuth[g], ahead, time[g], span)) return found;
  }
  return std::nullopt;
}

std::optional<Rotation> read_rotation(std::span<const int> azimuths, double motor_rpm, Nanoseconds period,
                                      int& worst) {
  assert(azimuths.size() >= 2 && azimuths.size() <= kMaxBlocks);
  Rotation r;
  r.groups = azimuths.size();
  r.period = period;
  std::ranges::copy(azimuths, r.azimuth.begin());
  const std::size_t steps = r.groups - 1;
  std::array<int, kMaxBlocks> step{};
  int turned = 0;
  for (std::size_t g = 0; g < steps; ++g) {
    step[g] = forward_step(azimuths[g], azimuths[g + 1]);
    turned += step[g];
  }
  std::array<int, kMaxBlocks> sorted = step;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((steps - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(steps));
  const int usual = std::max(*middle, 0);

  const double step_per_rpm = 6.0 * 100.0 * to_seconds(period);
  const double motor_step = motor_rpm * step_per_rpm;
  // Of one or two steps all may lead over what the sensor leaves out: then the motor alone tells.
  const bool only_jumps = usual > kMaxRpm * step_per_rpm;
  const bool motor_tells = steps <= 2 && motor_rpm > 0.0 && motor_rpm <= kMaxRpm;
  if (turned > kCentidegrees || (only_jumps && !motor_tells)) {
    worst = turned > kCentidegrees ? turned : usual;
    return std::nullopt;
  }

  const double expected = only_jumps ? motor_step : usual;
  const double tolerance = std::max(kMinStepTolerance, expected / 2.0);
  int fitting = 0;
  int sum = 0;
  for (std::size_t g = 0; g < steps; ++g) {
    r.jump[g] = std::abs(step[g] - expected) > tolerance;
    if (r.jump[g]) continue;
    ++fitting;
    sum += step[g];
  }
  const double seen = fitting > 0 ? std::max(0.0, static_cast<double>(sum) / fitting) : motor_step;
  r.step = motor_rpm <= kMaxRpm && agree(motor_step, seen) ? motor_step : seen;

  const bool rate_known = r.step >= kMinRpmToTimeJumps * step_per_rpm;
  for (std::size_t g = 0; g < steps; ++g) {
    const double periods = r.jump[g] && rate_known ? std::max(1.0, step[g] / r.step) : 1.0;
    r.time[g + 1] = r.time[g] + Nanoseconds(std::llround(periods * static_cast<double>(period.count())));
  }
  return r;
}

}  // namespace hulltrack::hesai
