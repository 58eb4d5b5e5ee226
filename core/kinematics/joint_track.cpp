#include "core/kinematics/joint_track.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {
namespace {

/// Shorter lines are not used. They say too little of the speed: 25 mm of jitter over this time are .25 m/s,
/// half of full speed.
constexpr Nanoseconds kShortestLine = std::chrono::milliseconds(100);
constexpr Nanoseconds kStill = std::chrono::milliseconds(500);

}  // namespace

std::optional<JointTrack::Misfit> JointTrack::misfit(const JointSample& sample,
                                                     MeasurementTime reach_until) const {
  reach_until = std::min(reach_until, sample.time);
  if (auto fast = too_fast(sample, reach_until)) {
    return fast;
  }
  for (auto entry = entries_.rbegin(); entry != entries_.rend() && newest_time() - entry->time <= kLine;
       ++entry) {
    if (!entry->line) {
      continue;
    }
    if (auto off = off_the_line(*entry->line, sample, reach_until)) {
      return off;
    }
  }
  return std::nullopt;
}

std::optional<JointTrack::Misfit> JointTrack::too_fast(const JointSample& sample,
                                                       MeasurementTime reach_until) const {
  const JointValues value = values_of(sample.joints);
  const double elapsed = to_seconds(reach_until - newest_time()) + spread_;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double off = std::abs(value[i] - newest()[i]);
    const double reach = max_rate_[i] * elapsed;
    if (!(off <= reach)) {
      return Misfit{i, true, off, reach};
    }
  }
  return std::nullopt;
}

/// A misfit if `sample` is farther from where the line leads than a machine can be. While a machine speeds up
/// by a, a line fitted over the time T has the speed of T / 2 ago, and its end is off by a T^2 / 12.
std::optional<JointTrack::Misfit> JointTrack::off_the_line(const Line& line, const JointSample& sample,
                                                           MeasurementTime reach_until) const {
  const JointValues value = values_of(sample.joints);
  const double T = to_seconds(line.span);
  const double since_mean = to_seconds(sample.time - line.time);
  const double h = std::max(0.0, to_seconds(reach_until - line.time) - T / 2.0);  // since the line's end
  const double bend = h * h / 2.0 + h * T / 2.0 + T * T / 12.0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double off = std::abs(value[i] - line.value[i] - line.rate[i] * since_mean);
    const double jitter = std::max(kHalfContract[i], std::abs(line.rate[i]) * spread_);
    const double allowed = jitter + kAcceleration[i] * bend;
    if (!(off <= allowed)) {
      return Misfit{i, false, off, allowed};
    }
  }
  return std::nullopt;
}

void JointTrack::add(const JointSample& sample) {
  if (entries_.empty()) {
    began_ = sample.time;
  }
  entries_.push_back({sample.time, values_of(sample.joints), std::nullopt});
  while (sample.time - entries_.front().time > kMemory) {
    entries_.pop_front();
  }
  auto fitted = line(sample.time - kLine, sample.time);
  if (fitted && fitted->span >= kShortestLine) {
    entries_.back().line = fitted;
  }
}

bool JointTrack::stands_still(const JointValues& tolerance) const {
  if (entries_.empty() || span() < kStill) {
    return false;
  }
  JointValues low = newest();
  JointValues high = newest();
  for (auto entry = entries_.rbegin(); entry != entries_.rend() && newest_time() - entry->time <= kStill;
       ++entry) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      low[i] = std::min(low[i], entry->value[i]);
      high[i] = std::max(high[i], entry->value[i]);
      if (high[i] - low[i] > tolerance[i]) {
        return false;
      }
    }
  }
  return true;
}

std::optional<JointTrack::Line> JointTrack::line(MeasurementTime first, MeasurementTime last) const {
  const auto begin = std::lower_bound(entries_.begin(), entries_.end(), first,
                                      [](const Entry& e, MeasurementTime time) { return e.time < time; });
  const auto end = std::upper_bound(begin, entries_.end(), last,
                                    [](MeasurementTime time, const Entry& e) { return time < e.time; });
  const auto count = static_cast<double>(end - begin);
  if (count < 2.0) {
    return std::nullopt;
  }
  Line line;
  line.span = std::prev(end)->time - begin->time;
  double mean = 0.0;  // s since `begin`
  for (auto entry = begin; entry != end; ++entry) {
    mean += to_seconds(entry->time - begin->time) / count;
    for (std::size_t i = 0; i < line.value.size(); ++i) {
      line.value[i] += entry->value[i] / count;
    }
  }
  double spread = 0.0;
  for (auto entry = begin; entry != end; ++entry) {
    const double t = to_seconds(entry->time - begin->time) - mean;
    spread += t * t;
    for (std::size_t i = 0; i < line.rate.size(); ++i) {
      line.rate[i] += t * (entry->value[i] - line.value[i]);
    }
  }
  for (double& rate : line.rate) {
    rate /= spread;
  }
  line.time = begin->time + Nanoseconds{static_cast<std::int64_t>(mean * 1e9)};
  return line;
}

}  // namespace hulltrack
