// Where were the joints at time t? Interpolates between samples, never holds or extrapolates.
//
// An answer exists only if accepted samples bracket t, at most kMaxGap apart. Outside it the reason
// is stated, because the caller acts on it: after the newest sample one may wait, before the oldest
// or inside a gap one may not.
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

  /// Between the two samples around t (from a sample on; at the newest one, up to it); nothing where at()
  /// has no answer, nor of a single sample.
  struct Motion {
    Joints joints;        // at t
    Joints rate;          // a second
    Nanoseconds spacing;  // of the samples
  };
  [[nodiscard]] std::optional<Motion> motion_at(MeasurementTime t) const;

  /// ok if every time in [first, last] has an answer; otherwise the first reason met.
  [[nodiscard]] Lookup covers(MeasurementTime first, MeasurementTime last) const;

  /// Whether an answer in [first, last] hangs on a sample that is on trial.
  [[nodiscard]] bool on_trial(MeasurementTime first, MeasurementTime last) const;

  [[nodiscard]] std::optional<JointSample> newest() const;
  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  void clear() { samples_.clear(); }

 private:
  std::size_t capacity_;
  std::deque<JointSample> samples_;
};

}  // namespace hulltrack
