#include "lidar_drivers/robosense/robosense_rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "lidar_drivers/rotor.hpp"

namespace hulltrack::robosense {

namespace {

/// Steps are whole 0.01 deg: the mean of a packet's may be off the set rate's by one.
constexpr double kSetRateTolerance = 1.0;

/// Are the blocks pairs of one azimuth that go on turning? Not told where nothing turns.
std::optional<bool> blocks_are_pairs(const std::array<int, kBlocks>& azimuth) {
  for (std::size_t b = 0; b < kBlocks; b += 2) {
    if (azimuth[b] != azimuth[b + 1]) return false;
  }
  if (azimuth.front() == azimuth.back()) return std::nullopt;
  return true;
}

}  // namespace

int RobosenseDecoder::Rotation::median_step() const {
  std::array<int, kBlocks> sorted = step;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((groups - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(groups - 1));
  return std::max(*middle, 0);
}

DecodeOutcome RobosenseDecoder::read_rotation(std::span<const std::uint8_t> payload, Rotation& r) const {
  std::array<int, kBlocks> azimuth{};
  for (std::size_t block = 0; block < kBlocks; ++block) {
    azimuth[block] = read_be16(payload, kHeaderBytes + block * kBlockBytes + 2);
    if (azimuth[block] >= kCentidegrees) {
      return {DecodeStatus::bad_azimuth, 0, static_cast<std::uint32_t>(azimuth[block])};
    }
  }
  r.dual = unit_->mode == ReturnMode::dual;
  if (model_.lasers == 32) {
    r.dual = blocks_are_pairs(azimuth).value_or(r.dual);
    r.blocks_per_group = r.dual ? 2 : 1;
  } else {
    if (unit_->mode == ReturnMode::unknown)
      return {DecodeStatus::wrong_return_mode, 0, unit_->mode_code};  // the slots' meaning is not known
    r.two_firings = !r.dual;
  }
  r.groups = kBlocks / r.blocks_per_group;
  r.span = (r.two_firings ? 2 : 1) * model_.period;
  r.last_pulse = last_pulse_ + (r.two_firings ? model_.period : Nanoseconds::zero());
  for (std::size_t g = 0; g < r.groups; ++g) r.azimuth[g] = azimuth[g * r.blocks_per_group];
  return find_jumps(r);
}

DecodeOutcome RobosenseDecoder::find_jumps(Rotation& r) const {
  int turned = 0;
  for (std::size_t g = 0; g + 1 < r.groups; ++g) {
    r.step[g] = rotor::forward_step(r.azimuth[g], r.azimuth[g + 1]);
    turned += r.step[g];
  }
  const int median = r.median_step();
  if (turned > kCentidegrees || median > r.step_at(kMaxRpm)) {
    return {DecodeStatus::bad_azimuth, 0, static_cast<std::uint32_t>(std::max(turned, median))};
  }

  // Sixteen lasers: the echoes' layout shows in nothing but the step, half as wide with two echoes.
  const double set_step = r.step_at(unit_->rpm);
  if (model_.lasers == 16 && unit_->rpm >= rotor::kMinRpmToTimeJumps) {
    const double other = r.dual ? 2.0 * set_step : 0.5 * set_step;
    if (std::abs(median - other) < 0.2 * other) {
      return {DecodeStatus::wrong_return_mode, static_cast<std::uint32_t>(std::lround(set_step)),
              static_cast<std::uint32_t>(median)};
    }
  }

  r.rate = rotor::fit_steps(std::span(r.step).first(r.groups - 1), median, r.jump).value_or(0.0);

  // The set rate while the rotor keeps to it: it does not carry the packet's own scatter.
  const bool at_set_rate = std::abs(std::round(set_step) - r.rate) <= kSetRateTolerance;
  const int nominal = static_cast<int>(std::lround(at_set_rate ? set_step : r.rate));
  const bool rate_known = r.rate >= r.step_at(rotor::kMinRpmToTimeJumps);
  for (std::size_t g = 0; g < r.groups; ++g) {
    const bool has_next = g + 1 < r.groups;
    r.advance[g] = has_next && !r.jump[g] ? r.step[g] : nominal;
    if (!has_next) break;
    r.time[g + 1] = r.time[g] + rotor::duration_of(r.step[g], r.jump[g], r.rate, rate_known, r.span);
  }
  r.duration = r.time[r.groups - 1] + r.last_pulse;
  return {};
}

}  // namespace hulltrack::robosense
