#include "daemon/pipeline/joint_gate.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.hpp"
#include "core/kinematics/joint_history.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kGap = JointHistory::kMaxGap;
/// (a): joints this near to where they stood are at the same place (ICD 2.1). Wear within the contract lets
/// an encoder drift by as much.
constexpr JointValues kSamePlace{0.02, radians(0.05), radians(0.05)};
/// (b): over a longer gap one steady motion is not assumed; the machine may well have made another.
constexpr Nanoseconds kLongestBridge = std::chrono::seconds(1);
/// (b): how long samples on either side of the gap must last to tell the speed. With 50 ms of jitter at full
/// speed, half a second tells it to 20 mm/s (1 sigma), 250 ms only to 60 mm/s.
constexpr Nanoseconds kSpeedKnown = milliseconds(500);
constexpr int kConfirmedFrames = 5;

/// By how much two time stamps may be off against each other: 80 ms without a heartbeat, 30 ms and the poll
/// period (at most 50 ms) with one. A value is as old as its PLC cycle allows (50 ms are a slow one), or as
/// the time since the poll that did not show it yet; a gateway adds 5 to 30 ms. A value that is later still
/// may be refused; the samples around it bridge it.
Nanoseconds stamp_spread(const JointGateConfig& config) {
  constexpr Nanoseconds kSlowCycle = milliseconds(50);
  constexpr Nanoseconds kGateway = milliseconds(30);
  return kGateway + (config.has_heartbeat ? std::min(config.poll_period, kSlowCycle) : kSlowCycle);
}

JointTrack empty_track(const JointGateConfig& config) {
  return {{config.travel.max_rate, config.slew.max_rate, config.luff.max_rate}, stamp_spread(config)};
}

bool within(const JointValues& a, const JointValues& b, const JointValues& tolerance) {
  bool all = true;
  for (std::size_t i = 0; i < a.size(); ++i) {
    all = all && std::abs(a[i] - b[i]) <= tolerance[i];
  }
  return all;
}

}  // namespace

JointGate::JointGate(const JointGateConfig& config)
    : config_(config),
      joints_{Joint{"travel", "m", 1.0, config.travel}, Joint{"slew", "deg", degrees(1.0), config.slew},
              Joint{"luff", "deg", degrees(1.0), config.luff}},
      believed_(empty_track(config)),
      trial_{empty_track(config)} {}

bool JointGate::is_news(const JointReading& reading) const {
  const bool later = !last_ || reading.sample.time > last_->sample.time;
  const bool moved = !last_ || !config_.has_heartbeat || reading.heartbeat != last_->heartbeat;
  return later && moved;
}

JointGate::Outcome JointGate::offer(const JointReading& reading) {
  if (!is_news(reading)) {
    return {Verdict::no_news, last_outcome_.faults, last_outcome_.reason, last_outcome_.needs_edge};
  }
  last_ = reading;
  last_outcome_ = judge(reading.sample);
  return last_outcome_;
}

void JointGate::reacquire() {
  believed_.clear();
  established_ = false;
  end_trial();
  last_outcome_ = {};
}

JointGate::Outcome JointGate::judge(const JointSample& sample) {
  if (std::string reason = out_of_range(sample); !reason.empty()) {
    return {Verdict::refused, fault::plc_value, std::move(reason), false};
  }
  const bool gap = !believed_.empty() && sample.time - believed_.newest_time() > kGap;
  if (gap && !established_) {
    believed_.clear();
  }
  if (believed_.empty()) {
    return believe(sample);
  }
  if (gap) {
    return try_out(sample);
  }
  // The time to change speed ends when the first value is refused: what is plausible does not grow with the
  // wait.
  const auto misfit = believed_.misfit(sample, trial_.track.empty() ? sample.time : trial_.track.began());
  return misfit ? refuse_motion(sample, *misfit) : believe(sample);
}

JointGate::Outcome JointGate::believe(const JointSample& sample) {
  believed_.add(sample);
  established_ = established_ || believed_.span() >= kSpeedKnown;
  end_trial();
  return {Verdict::believed, 0, {}, false};
}

JointGate::Outcome JointGate::refuse_motion(const JointSample& sample, const JointTrack::Misfit& misfit) {
  if (trial_.track.empty()) {
    begin_trial(sample, true);
  } else if (!trial_.track.misfit(sample, sample.time)) {
    continue_trial(sample);
  }
  return {Verdict::refused, fault::plc_value, misfit_words(sample, misfit), false};
}

JointGate::Outcome JointGate::try_out(const JointSample& sample) {
  if (!trial_.track.empty() && sample.time - trial_.track.newest_time() > kGap) {
    end_trial();
  }
  if (trial_.track.empty()) {
    begin_trial(sample, false);
  } else if (const auto misfit = trial_.track.misfit(sample, sample.time)) {
    return {Verdict::refused, fault::plc_value, misfit_words(sample, *misfit), last_outcome_.needs_edge};
  } else {
    continue_trial(sample);
  }
  if (trial_confirms()) {
    believe_trial();
    return {Verdict::believed, 0, {}, false};
  }
  const bool needs_edge = !trial_.at_old_place && !trial_.fits_motion;
  return {Verdict::on_trial, fault::plc_value, trial_words(sample, needs_edge), needs_edge};
}

void JointGate::begin_trial(const JointSample& sample, bool contradicts) {
  trial_.at_old_place = believed_.stands_still(kSamePlace);
  trial_.fits_motion = !contradicts && sample.time - believed_.newest_time() < kLongestBridge;
  continue_trial(sample);
}

void JointGate::continue_trial(const JointSample& sample) {
  trial_.track.add(sample);
  trial_.at_old_place =
      trial_.at_old_place && within(values_of(sample.joints), believed_.newest(), kSamePlace);
}

bool JointGate::trial_confirms() {
  if (trial_.at_old_place && trial_.track.span() >= kGap) {
    return true;
  }
  if (trial_.fits_motion && trial_.track.span() >= kSpeedKnown) {
    trial_.fits_motion = is_one_motion();
    return trial_.fits_motion;
  }
  return false;
}

/// (b): with constant acceleration, the way between two times is the mean of the two speeds times the time
/// between. The way that the joints made has to agree with that, and the change of speed with kAcceleration.
bool JointGate::is_one_motion() const {
  const MeasurementTime suspect = believed_.newest_time() - kGap;
  const auto before = believed_.line(suspect - kSpeedKnown, suspect);
  const auto after = trial_.track.line(trial_.track.newest_time() - kSpeedKnown, trial_.track.newest_time());
  if (!before || !after || before->span < kSpeedKnown / 2) {
    return false;
  }
  const double elapsed = to_seconds(after->time - before->time);
  JointValues expected = before->value;
  JointValues rates{};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    expected[i] += (before->rate[i] + after->rate[i]) / 2.0 * elapsed;
    rates[i] = after->rate[i] - before->rate[i];
  }
  JointValues most = kAcceleration;
  for (double& change : most) {
    change *= elapsed;
  }
  return within(after->value, expected, kHalfContract) && within(rates, {}, most);
}

void JointGate::believe_trial() {
  believed_ = trial_.track;
  established_ = true;
  end_trial();
}

void JointGate::end_trial() { trial_ = {empty_track(config_)}; }

void JointGate::frame_done(MeasurementTime first, MeasurementTime last, bool confirmed) {
  if (last_outcome_.faults == 0 || trial_.track.empty()) {
    return;
  }
  const bool inside = first >= trial_.track.began() && last <= trial_.track.newest_time();
  trial_.confirmed = confirmed && inside ? trial_.confirmed + 1 : 0;
  if (trial_.confirmed >= kConfirmedFrames) {
    believe_trial();
    last_outcome_ = {};
  }
}

std::string JointGate::out_of_range(const JointSample& sample) const {
  const JointValues value = values_of(sample.joints);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    if (!std::isfinite(value[i]) || value[i] < joint.limits.min || value[i] > joint.limits.max) {
      return format_text("%s %.3f %s is outside %.3f to %.3f %s", joint.name, value[i] * joint.display,
                         joint.unit, joint.limits.min * joint.display, joint.limits.max * joint.display,
                         joint.unit);
    }
  }
  return {};
}

std::string JointGate::misfit_words(const JointSample& sample, const JointTrack::Misfit& misfit) const {
  const Joint& joint = joints_[misfit.joint];
  const double value = values_of(sample.joints)[misfit.joint] * joint.display;
  const double off = misfit.off * joint.display;
  if (misfit.rate) {
    return format_text(
        "%s %.3f %s is %.3f %s from the value before, more than its max_rate of %.3f %s/s allows", joint.name,
        value, joint.unit, off, joint.unit, joint.limits.max_rate * joint.display, joint.unit);
  }
  return format_text("%s %.3f %s is %.3f %s from where its motion leads, a machine can be off by %.3f %s",
                     joint.name, value, joint.unit, off, joint.unit, misfit.allowed * joint.display,
                     joint.unit);
}

/// Names the joint that is farthest from its last believed value, in units of kHalfContract.
std::string JointGate::trial_words(const JointSample& sample, bool needs_edge) const {
  const JointValues value = values_of(sample.joints);
  const JointValues& old = believed_.newest();
  std::size_t worst = 0;
  const auto share = [&](std::size_t i) { return std::abs(value[i] - old[i]) / kHalfContract[i]; };
  for (std::size_t i = 1; i < value.size(); ++i) {
    worst = share(i) > share(worst) ? i : worst;
  }
  const Joint& joint = joints_[worst];
  const char* wait = !needs_edge           ? "joint values are on trial"
                     : config_.has_command ? "joint values wait for a re-acquire edge (command bit 1)"
                                           : "joint values wait for a restart of the service, since "
                                             "plc.read.command is -1";
  return format_text("%s: none was believed for %.1f s, %s was %.3f %s then and is %.3f %s now", wait,
                     to_seconds(sample.time - believed_.newest_time()), joint.name,
                     old[worst] * joint.display, joint.unit, value[worst] * joint.display, joint.unit);
}

}  // namespace hulltrack
