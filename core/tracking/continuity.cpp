#include "core/tracking/continuity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

// A pose may lie kFastestHull * dt + kJumpNoise from the last accepted one; farther is a jump. kJumpNoise is
// the error of the two poses: a healthy one is off by less than 5 cm.
constexpr double kJumpNoise = 0.10;  // m
// The attitude may change by kTurnRate * dt + kTurnNoise, the second for the error of the two poses. A moored
// ship that rolls by 1 deg in a quarter of a period of 8 s turns by 0.8 deg/s at most.
const double kTurnNoise = radians(0.3);  // rad
const double kTurnRate = radians(1.0);   // rad/s
// Noise of the measured rate of yaw; it is taken off before the hull's ends count as too fast. Three sigma of
// HullSpeedRecord's rate if each yaw has 0.016 deg of noise. In 50,000 simulated healthy frames the rate was
// off by more only once, by 0.1003 deg/s.
const double kYawRateNoise = radians(0.1);  // rad/s

/// A part of the hull that is faster than max_speed: its speed, m/s, and words for the log. The reference
/// point is judged first, then the hull's ends by the rate of yaw less its noise. Nothing if both are slow.
struct FastPart {
  double speed;
  std::string words;
};
std::optional<FastPart> fast_part(const HealthLimits& limits, const HullSpeed& hull) {
  const double speed = hull.velocity.norm();
  if (speed > limits.max_speed) {
    return FastPart{
        speed, format_text("the hull moves at %.2f m/s, max_speed is %.2f m/s", speed, limits.max_speed)};
  }
  const double turning = std::abs(hull.rpy_rate.z());
  const double ends = turning * limits.half_length;
  if (ends - kYawRateNoise * limits.half_length > limits.max_speed) {
    return FastPart{ends, format_text("the hull turns at %.2f deg/s and its ends at %.2f m/s, max_speed is "
                                      "%.2f m/s",
                                      degrees(turning), ends, limits.max_speed)};
  }
  return std::nullopt;
}

/// Adds speed times the time since the last fast frame to the run. A pause of up to HullSpeedRecord::kWindow
/// does not end a run, because noise makes a fast hull look slow for some frames.
void note_run(HealthMemory& memory, MeasurementTime time, double speed) {
  if (!memory.run || time - memory.run->last > HullSpeedRecord::kWindow) {
    memory.run = {0.0, time};
  }
  memory.run->length += speed * std::max(0.0, to_seconds(time - memory.run->last));
  memory.run->last = time;
  memory.ran_away = memory.ran_away || memory.run->length > kLongestRun;
}

}  // namespace

void check_continuity(HealthMemory& memory, const FrameFindings& e, Objections& objections) {
  if (!memory.track.followed) {
    return;
  }
  const double dt = std::max(0.0, to_seconds(e.time - memory.track.followed->time));
  const double reach = kFastestHull * dt + kJumpNoise;
  if (reach > kUnseen) {
    memory.track.searches += memory.track.unique ? 1 : 0;  // else a search is under way
    memory.track.unique = false;
    memory.track.followed.reset();
    memory.track.speed_record = HullSpeedRecord{};
    return;
  }
  const double jump =
      (e.registration.pose.displacement() - memory.track.followed->pose.displacement()).norm();
  if (!memory.track.unique && jump > reach) {  // the search found another place: no fault, no speed
    memory.track.speed_record = HullSpeedRecord{};
    return;
  }
  if (jump > reach) {
    objections.add(
        State::degraded, fault::implausible,
        format_text("pose jumped by %.2f m in %.1f s, at most %.2f m is possible", jump, dt, reach));
  }
  const double turn =
      rotation_angle(memory.track.followed->pose.rotation().transpose() * e.registration.pose.rotation());
  if (turn > kTurnRate * dt + kTurnNoise) {
    objections.add(State::degraded, fault::implausible,
                   format_text("pose turned by %.2f deg in %.1f s", degrees(turn), dt));
  }
}

void check_speed(const HealthLimits& limits, HealthMemory& memory, MeasurementTime time,
                 Objections& objections) {
  if (const auto speed = memory.track.speed_record.speed()) {
    if (auto fast = fast_part(limits, *speed)) {
      note_run(memory, time, fast->speed);
      objections.add(State::degraded, fault::implausible, std::move(fast->words));
    }
  }
  if (memory.ran_away) {
    objections.add(
        State::lost, fault::implausible,
        format_text("the hull seems to have run more than %.0f m faster than max_speed: she is or was "
                    "under way, or an encoder stands still while the loader moves. When she is moored "
                    "and travel, slew and luff are right: a re-acquire edge",
                    kLongestRun));
  }
}

}  // namespace hulltrack
