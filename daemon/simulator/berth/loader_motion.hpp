// Where are the loader's joints at time t? A loader at work: it travels, slews and luffs with trapezoidal
// speed ramps, one or two axes at a time, and pours in between.
//
// Seconds from the first firing; m and rad. Every move keeps within `limits`. The whole run is planned at
// construction from the seed; afterwards any time may be asked from any thread. Before the first and after
// the last move the joints stand still. About 0.1 us.
#pragma once

#include <cstdint>
#include <vector>

#include "core/kinematics/joints.hpp"

namespace hulltrack {

/// One axis: where it works, how fast it may go and speed up. m or rad.
struct AxisLimits {
  double low, high;
  double speed, acceleration;
  double shortest_move, longest_move;  // of one move
};

/// Where a loader works and how it goes about it.
struct LoaderLimits {
  AxisLimits travel, slew, luff;
  double shortest_pour = 1.5, longest_pour = 7.0;  // s between two moves
  bool hurries = false;                            // every move is one of travel and slew together
  bool passes = false;  // travels to and fro over the whole range without a stop, whatever the boom does
};

class LoaderMotion {
 public:
  /// Works for `duration` s, starting somewhere inside the limits.
  LoaderMotion(const LoaderLimits& limits, double duration, std::uint64_t seed);

  /// Parked: never moves.
  explicit LoaderMotion(const Joints& parked) : start_(parked) {}

  [[nodiscard]] Joints at(double t) const;
  /// Do all axes stand still? That is when it pours.
  [[nodiscard]] bool at_rest(double t) const;

 private:
  struct Move {
    double start;  // s
    double from, to;
    double speed, acceleration;
    [[nodiscard]] double at(double t) const;
    [[nodiscard]] double duration() const;
  };
  using Track = std::vector<Move>;
  static double position(const Track& track, double start, double t);
  void plan_passes(const AxisLimits& axis, double duration);

  Joints start_;
  Track travel_, slew_, luff_;
};

}  // namespace hulltrack
