// Averages the bend of the hull (hog and sag, bend.hpp) over frames.
//
// In: each frame's own estimate with its sigma. Out: the mean and its sigma. A Kalman filter of one number
// that drifts slowly. One frame sees some 40 m of the ship and knows the bend to a few centimetres. About ten
// frames in a row see the same stretch with the same errors, so each frame's variance is first multiplied by
// kShared. Metres, + sag. A plain value. No failure: measurements that are not finite are left out.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/time.hpp"
#include "core/registration/bend.hpp"

namespace hulltrack {

class BendFilter {
 public:
  /// Before the first frame the bend is 0 with a sigma of `length` / 1000, and the sigma never grows beyond
  /// that: a hull bends by up to a thousandth of its length (class rules for the still water bending of a
  /// loading ship).
  explicit BendFilter(double length) : bend_{0.0, length / 1000.0}, widest_(bend_.sigma) {}

  static constexpr double kShared = 10.0;
  /// Each second adds kWander^2 to the variance, so that old frames lose weight. Over a quarter of an hour,
  /// in which a hold can be filled, that is a sigma of 3 cm. m / sqrt(s)
  static constexpr double kWander = 0.001;

  [[nodiscard]] const Bend& now() const { return bend_; }

  /// `d`, `sigma`: what this frame alone says, without the average that went into its fit.
  void update(MeasurementTime time, double d, double sigma) {
    if (!std::isfinite(d) || !(sigma > 0.0) || !std::isfinite(sigma)) {
      return;
    }
    const double elapsed = last_ ? std::max(0.0, to_seconds(time - *last_)) : 0.0;
    last_ = time;
    const double before =
        std::min(bend_.sigma * bend_.sigma + kWander * kWander * elapsed, widest_ * widest_);
    const double gain = before / (before + kShared * sigma * sigma);
    bend_.d += gain * (d - bend_.d);
    bend_.sigma = std::sqrt((1.0 - gain) * before);
  }

 private:
  Bend bend_;
  double widest_;
  std::optional<MeasurementTime> last_;
};

}  // namespace hulltrack
