// Do joint samples follow one motion that the machine can make?
//
// A short record of samples that belong together. From the last 250 ms before each of them a line is fitted,
// which gives position and speed. A machine cannot change its speed faster than kAcceleration, so the next
// sample has to lie within half the contract of what position, speed and that acceleration allow, seen from
// every sample of the last 250 ms. A torn value and a joint that freezes at speed are off at once.
//   What cannot be told from a machine that moves so: an error below half the contract and 5 mm or .012 deg,
// which is what the fit of a machine that brakes is off by; a freeze below some .35 m/s or .8 deg/s, which
// looks like a stop (a real one takes v^2 / 2a); a slip or drift that grows slower than that.
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

/// Half of what health 1 promises, m and rad.
inline constexpr JointValues kHalfContract{HealthContract::kPosition / 2, HealthContract::kAttitude / 2,
                                           HealthContract::kAttitude / 2};

/// No machine speeds up or brakes faster, m/s^2 and rad/s^2: wet steel on rails carries .15 g and about two
/// thirds of the wheels have brakes, so .1 g, five times what drives do; as much at the tip of a short boom
/// of 25 m. One that stops harder still loses its health for the stop.
inline constexpr JointValues kAcceleration{1.0, 1.0 / 25.0, 1.0 / 25.0};

class JointTrack {
 public:
  /// How long a sample looks back for its line.
  static constexpr Nanoseconds kLine = std::chrono::milliseconds(250);
  /// How much of the past is kept.
  static constexpr Nanoseconds kMemory = std::chrono::seconds(1);

  /// `max_rate`: m/s or rad/s. `stamp_spread`: how far two stamps may be off against each other. A joint at v
  /// is allowed v * stamp_spread where that is more than half the contract: .5 m/s with 50 ms.
  JointTrack(const JointValues& max_rate, Nanoseconds stamp_spread)
      : max_rate_(max_rate), spread_(to_seconds(stamp_spread)) {}

  /// What a sample that does not belong here is off by.
  struct Misfit {
    std::size_t joint = 0;
    bool rate = false;  // it would have to move faster than max_rate since the newest sample
    double off = 0.0;   // from the newest sample, or from where the motion leads
    double allowed = 0.0;
  };
  /// Nothing if `sample`, later than the newest, can be the next one. The machine is given the time until
  /// `reach_until` to change its speed, not more than until the sample. Precondition: not empty, finite.
  [[nodiscard]] std::optional<Misfit> misfit(const JointSample& sample, MeasurementTime reach_until) const;

  void add(const JointSample& sample);
  void clear() { entries_.clear(); }

  [[nodiscard]] bool empty() const { return entries_.empty(); }
  /// Of the first sample ever added, also when it is forgotten. Precondition: not empty, as for newest().
  [[nodiscard]] MeasurementTime began() const { return began_; }
  [[nodiscard]] MeasurementTime newest_time() const { return entries_.back().time; }
  [[nodiscard]] const JointValues& newest() const { return entries_.back().value; }
  [[nodiscard]] Nanoseconds span() const { return newest_time() - began_; }

  /// No joint's values differ by more than `tolerance` in the last half second.
  [[nodiscard]] bool stands_still(const JointValues& tolerance) const;

  /// The line through the samples of a while, at the mean of their times.
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
    std::optional<Line> line;  // of the samples up to this one, once they last long enough
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
