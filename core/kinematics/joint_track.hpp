// Do joint samples follow one motion that the machine can make?
//
// A short record of samples that belong together. A line through the last 250 ms before each sample gives
// position and speed there. A machine cannot change its speed faster than kAcceleration. So the next sample
// has to lie within half the contract (kHalfContract) of where position, speed and that acceleration can
// lead, as seen from every sample of the last 250 ms. A torn value, or a joint that freezes at speed, is off
// at once.
// What passes, because a machine may move so:
//   - an error below half the contract plus 5 mm or .012 deg: the line's own error while a machine brakes;
//   - a freeze below some .35 m/s or .8 deg/s: it looks like a stop (a real one takes v^2 / 2a);
//   - a slip or drift that grows more slowly than that.
// SI units (m, rad, s). No failure. Thread rule: one owner. Cost: a second of samples, some 10 us at 20 ms.
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "core/geometry/health_contract.hpp"
#include "core/kinematics/joints.hpp"

namespace hulltrack {

/// Travel, slew, luff.
using JointValues = std::array<double, 3>;

[[nodiscard]] inline JointValues values_of(const Joints& joints) {
  return {joints.d_x, joints.theta_r, joints.theta_p};
}

/// Half of what health 1 promises (ICD 3.1), m and rad.
inline constexpr JointValues kHalfContract{HealthContract::kPosition / 2, HealthContract::kAttitude / 2,
                                           HealthContract::kAttitude / 2};

/// No machine speeds up or brakes faster, m/s^2 and rad/s^2. Travel: wet steel on rails carries .15 g and
/// about two thirds of the wheels have brakes, so .1 g, five times what drives do. Slew and luff: as much at
/// the tip of a short boom of 25 m. A machine that stops harder loses its health for the stop.
inline constexpr JointValues kAcceleration{1.0, 1.0 / 25.0, 1.0 / 25.0};

class JointTrack {
 public:
  /// How much time before a sample its line is fitted over.
  static constexpr Nanoseconds kLine = std::chrono::milliseconds(250);
  /// How long samples are kept.
  static constexpr Nanoseconds kMemory = std::chrono::seconds(1);

  /// `max_rate`: m/s or rad/s. `stamp_spread`: by how much two time stamps may be off against each other. A
  /// joint at speed v may be off its line by v * stamp_spread if that is more than half the contract: with 50
  /// ms from .5 m/s on.
  JointTrack(const JointValues& max_rate, Nanoseconds stamp_spread)
      : max_rate_(max_rate), spread_(to_seconds(stamp_spread)) {}

  /// How far a sample is off that does not belong to the record.
  struct Misfit {
    std::size_t joint = 0;
    bool rate = false;  // the joint would have to move faster than max_rate since the newest sample
    double off = 0.0;   // m or rad, from the newest sample (rate) or from where the motion leads
    double allowed = 0.0;
  };
  /// Nothing if `sample` (later than the newest one) can be the next. The machine is given the time until
  /// `reach_until`, or until the sample if that is earlier, to change its speed. Precondition: not empty,
  /// finite.
  [[nodiscard]] std::optional<Misfit> misfit(const JointSample& sample, MeasurementTime reach_until) const;

  void add(const JointSample& sample);
  void clear() { entries_.clear(); }

  [[nodiscard]] bool empty() const { return entries_.empty(); }
  /// Time of the first sample since the record was empty, also when that sample is forgotten. Precondition:
  /// not empty, as for newest().
  [[nodiscard]] MeasurementTime began() const { return began_; }
  [[nodiscard]] MeasurementTime newest_time() const { return entries_.back().time; }
  [[nodiscard]] const JointValues& newest() const { return entries_.back().value; }
  [[nodiscard]] Nanoseconds span() const { return newest_time() - began_; }

  /// No joint's values differ by more than `tolerance` in the last half second.
  [[nodiscard]] bool stands_still(const JointValues& tolerance) const;

  /// A straight line through some samples: `value` at `time`, the mean of their times, and `rate` per second.
  struct Line {
    MeasurementTime time{};
    Nanoseconds span{0};
    JointValues value{}, rate{};
  };
  /// Nothing if there are fewer than two samples in [first, last].
  [[nodiscard]] std::optional<Line> line(MeasurementTime first, MeasurementTime last) const;

 private:
  struct Entry {
    MeasurementTime time;
    JointValues value;
    std::optional<Line> line;  // through the last samples up to this one, if they span enough
  };
  [[nodiscard]] std::optional<Misfit> too_fast(const JointSample& sample, MeasurementTime reach_until) const;
  [[nodiscard]] std::optional<Misfit> off_the_line(const Line& line, const JointSample& sample,
                                                   MeasurementTime reach_until) const;

  JointValues max_rate_;
  double spread_;  // s
  std::deque<Entry> entries_;
  MeasurementTime began_{};
};

}  // namespace hulltrack
