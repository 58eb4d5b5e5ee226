#include "core/kinematics/joint_history.hpp"

#include <algorithm>
#include <iterator>

namespace hulltrack {
namespace {

double mix(double a, double b, double w) { return a + w * (b - a); }

}  // namespace

bool JointHistory::add(const JointSample& sample) {
  if (!samples_.empty() && sample.time <= samples_.back().time) {
    return false;
  }
  samples_.push_back(sample);
  if (samples_.size() > capacity_) {
    samples_.pop_front();
  }
  return true;
}

JointHistory::Answer JointHistory::at(MeasurementTime t) const {
  if (samples_.empty()) {
    return {Lookup::empty, {}};
  }
  const auto after =
      std::lower_bound(samples_.begin(), samples_.end(), t,
                       [](const JointSample& s, MeasurementTime time) { return s.time < time; });
  if (after == samples_.end()) {
    return {Lookup::after_newest, {}};
  }
  if (after->time == t) {
    return {Lookup::ok, after->joints};
  }
  if (after == samples_.begin()) {
    return {Lookup::before_oldest, {}};
  }
  const JointSample& a = *std::prev(after);
  const JointSample& b = *after;
  if (b.time - a.time > kMaxGap) {
    return {Lookup::gap, {}};
  }
  const double w = to_seconds(t - a.time) / to_seconds(b.time - a.time);
  return {Lookup::ok,
          {mix(a.joints.d_x, b.joints.d_x, w), mix(a.joints.theta_r, b.joints.theta_r, w),
           mix(a.joints.theta_p, b.joints.theta_p, w)}};
}

std::optional<JointHistory::State> JointHistory::motion_at(MeasurementTime t) const {
  const Answer answer = at(t);
  if (answer.lookup != Lookup::ok || samples_.size() < 2) {
    return std::nullopt;
  }
  auto after = std::upper_bound(samples_.begin(), samples_.end(), t,
                                [](MeasurementTime time, const JointSample& s) { return time < s.time; });
  if (after == samples_.end()) {
    --after;
  }
  const JointSample& a = *std::prev(after);
  const JointSample& b = *after;
  const double dt = to_seconds(b.time - a.time);
  return State{answer.joints,
               {(b.joints.d_x - a.joints.d_x) / dt, (b.joints.theta_r - a.joints.theta_r) / dt,
                (b.joints.theta_p - a.joints.theta_p) / dt},
               b.time - a.time};
}

JointHistory::Lookup JointHistory::covers(MeasurementTime first, MeasurementTime last) const {
  if (const Lookup begin = at(first).lookup; begin != Lookup::ok) {
    return begin;
  }
  if (const Lookup end = at(last).lookup; end != Lookup::ok) {
    return end;
  }
  const auto later = [](MeasurementTime time, const JointSample& s) { return time < s.time; };
  auto b = std::upper_bound(samples_.begin(), samples_.end(), first, later);
  for (; b != samples_.end() && std::prev(b)->time < last; ++b) {
    if (b->time - std::prev(b)->time > kMaxGap) {
      return Lookup::gap;
    }
  }
  return Lookup::ok;
}

bool JointHistory::on_trial(MeasurementTime first, MeasurementTime last) const {
  const auto earlier = [](const JointSample& s, MeasurementTime time) { return s.time < time; };
  const auto later = [](MeasurementTime time, const JointSample& s) { return time < s.time; };
  auto begin = std::upper_bound(samples_.begin(), samples_.end(), first, later);
  if (begin != samples_.begin()) {
    --begin;  // the sample at or before the first time
  }
  auto end = std::lower_bound(begin, samples_.end(), last, earlier);
  if (end != samples_.end()) {
    ++end;  // the sample at or after the last time
  }
  return std::any_of(begin, end, [](const JointSample& s) { return s.on_trial; });
}

std::optional<JointSample> JointHistory::newest() const {
  if (samples_.empty()) {
    return std::nullopt;
  }
  return samples_.back();
}

}  // namespace hulltrack
