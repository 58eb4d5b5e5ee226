#include "core/kinematics/joint_gate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/geometry/se3.hpp"
#include "core/kinematics/joint_history.hpp"

namespace hulltrack {

JointGate::JointGate(const JointGateConfig& config)
    : config_(config),
      joints_{Joint{"travel", "m", 1.0, config.travel, {}, {}, {}, {}, 0.0},
              Joint{"slew", "deg", degrees(1.0), config.slew, {}, {}, {}, {}, 0.0},
              Joint{"luff", "deg", degrees(1.0), config.luff, {}, {}, {}, {}, 0.0}} {}

bool JointGate::is_news(const JointReading& reading) const {
  const bool later = !last_ || reading.sample.time > last_->sample.time;
  const bool moved = !last_ || !config_.has_heartbeat || reading.heartbeat != last_->heartbeat;
  return later && moved;
}

JointGate::Outcome JointGate::offer(const JointReading& reading) {
  if (!is_news(reading)) {
    return {Verdict::no_news, last_outcome_.faults, last_outcome_.reason};
  }
  const MeasurementTime time = reading.sample.time;
  last_ = reading;

  const Joints& v = reading.sample.joints;
  const std::array<double, 3> values{v.d_x, v.theta_r, v.theta_p};
  std::string reason;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    std::string refusal = judge(joints_[i], values[i], time);
    if (reason.empty()) {
      reason = std::move(refusal);
    }
  }
  last_outcome_ = reason.empty() ? Outcome{Verdict::believed, 0, {}}
                                 : Outcome{Verdict::refused, fault::plc_value, std::move(reason)};
  return last_outcome_;
}

void JointGate::reacquire() {
  for (Joint& joint : joints_) {
    joint.reference.reset();
    joint.refused.reset();
  }
  last_outcome_ = {};
}

std::string JointGate::judge(Joint& joint, double value, MeasurementTime time) const {
  std::array<char, 200> text{};
  const auto shown = [&joint](double v) { return v * joint.display; };
  if (!std::isfinite(value) || value < joint.limits.min || value > joint.limits.max) {
    std::snprintf(text.data(), text.size(), "%s %.3f %s is outside %.3f to %.3f %s", joint.name, shown(value),
                  joint.unit, shown(joint.limits.min), shown(joint.limits.max), joint.unit);
    return text.data();
  }
  const double allowance = joint.reference ? reach(joint, time - joint.reference_time) : 0.0;
  const bool believed = !joint.reference || (joint.refused ? comes_back(joint, value, time)
                                                           : std::abs(value - *joint.reference) <= allowance);
  if (believed) {
    joint.reference = value;
    joint.reference_time = time;
    joint.refused.reset();
    return {};
  }
  if (!joint.refused) {
    joint.frozen_allowance = allowance;
  }
  joint.refused = value;
  joint.refused_time = time;
  std::snprintf(
      text.data(), text.size(),
      "%s %.3f %s is %.3f %s from the last believed value, more than its max_rate of %.3f %s/s allows",
      joint.name, shown(value), joint.unit, shown(std::abs(value - *joint.reference)), joint.unit,
      shown(joint.limits.max_rate), joint.unit);
  return text.data();
}

bool JointGate::comes_back(const Joint& joint, double value, MeasurementTime time) const {
  const double from_reference = std::abs(value - *joint.reference);
  if (from_reference <= joint.frozen_allowance) {
    return true;
  }
  const bool breaks_with_refused = std::abs(value - *joint.refused) > reach(joint, time - joint.refused_time);
  const Nanoseconds elapsed = std::min(time - joint.reference_time, JointHistory::kMaxGap);
  return breaks_with_refused && from_reference <= reach(joint, elapsed);
}

double JointGate::reach(const Joint& joint, Nanoseconds elapsed) const {
  return joint.limits.max_rate * to_seconds(elapsed + config_.poll_period);
}

}  // namespace hulltrack
