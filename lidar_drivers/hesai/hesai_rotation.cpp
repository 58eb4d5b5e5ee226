#include "lidar_drivers/hesai/hesai_rotation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/rotor.hpp"

namespace hulltrack::hesai {

namespace {

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
    const auto passed = rotor::time_to_zero(from, ahead, span);
    if (!passed || at + *passed < first || at + *passed > last) return std::nullopt;
    return at + *passed;
  };
  // Before the first reference and after the last one the rotor goes on evenly.
  if (const auto found =
          crossing(azimuth[0] - step + (azimuth[0] < step ? kCentidegrees : 0), step, -period, period))
    return found;
  for (std::size_t g = 0; g < groups; ++g) {
    const bool has_next = g + 1 < groups;
    const double ahead = has_next ? rotor::forward_step(azimuth[g], azimuth[g + 1]) : step;
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
    step[g] = rotor::forward_step(azimuths[g], azimuths[g + 1]);
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
  const double seen = rotor::fit_steps(std::span(step).first(steps), expected, r.jump).value_or(motor_step);
  r.step = motor_rpm <= kMaxRpm && agree(motor_step, seen) ? motor_step : seen;

  const bool rate_known = r.step >= rotor::kMinRpmToTimeJumps * step_per_rpm;
  for (std::size_t g = 0; g < steps; ++g) {
    r.time[g + 1] = r.time[g] + rotor::duration_of(step[g], r.jump[g], r.step, rate_known, period);
  }
  return r;
}

}  // namespace hulltrack::hesai
