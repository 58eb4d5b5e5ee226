// Where were the joints at time t? Interpolates between samples, never holds or extrapolates.
//
// An answer exists only if samples lie before and after t (or at t), at most kMaxGap apart. Otherwise the
// reason is given, because the caller acts on it: after the newest sample one may wait for the next; before
// the oldest one, or in a gap, there is nothing to wait for.
// Bounded memory: the newest `capacity` samples. Thread rule: one owner; copy to hand over.
// Cost: O(log n) a look-up.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "core/kinematics/joints.hpp"

namespace hulltrack {

class JointHistory {
 public:
  /// Samples further apart than this do not bracket anything (ICD 2.1).
  static constexpr Nanoseconds kMaxGap = std::chrono::milliseconds(250);

  enum class Lookup { ok, empty, before_oldest, after_newest, gap };

  struct Answer {
    Lookup lookup = Lookup::empty;
    Joints joints;  // meaningful only if lookup == ok
  };

  /// capacity >= 2; 1024 samples at 20 ms are 20 s.
  explicit JointHistory(std::size_t capacity = 1024) : capacity_(capacity) {}

  /// Appends; a sample not later than the newest is refused (false) and changes nothing.
  bool add(const JointSample& sample);

  [[nodiscard]] Answer at(MeasurementTime t) const;

  /// Joints and their rates at t, from the samples around t: at a sample from that one and the next, at the
  /// newest from the last two. Nothing where at() has no answer, or if there is a single sample.
  struct State {
    Joints joints;        // at t
    Joints rate;          // per second: m/s, rad/s
    Nanoseconds spacing;  // between the two samples
  };
  [[nodiscard]] std::optional<State> motion_at(MeasurementTime t) const;

  /// ok if every time in [first, last] has an answer; otherwise the first reason met.
  [[nodiscard]] Lookup covers(MeasurementTime first, MeasurementTime last) const;

  /// Whether an answer in [first, last] depends on a sample that is on trial (see joint_gate.hpp).
  [[nodiscard]] bool on_trial(MeasurementTime first, MeasurementTime last) const;

  [[nodiscard]] std::optional<JointSample> newest() const;
  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  void clear() { samples_.clear(); }

 private:
  std::size_t capacity_;
  std::deque<JointSample> samples_;
};

}  // namespace hulltrack
