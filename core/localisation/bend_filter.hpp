// How far is the hull bent, from many frames?
//
// A Kalman filter of one constant that wanders slowly. One frame sees a stretch of some 40 m and knows the
// bend to a few centimetres; frames of one second share their view and with it their errors, so each counts
// a kShared-th. Metres, + sag. A plain value. No failure: measurements that are not finite are left out.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/time.hpp"
#include "core/registration/bend.hpp"

namespace hulltrack {

class BendFilter {
 public:
  /// A hull bends by up to a thousandth of its length (class rules for the still water bending of a loading
  /// ship): the 1-sigma before the first frame.
  explicit BendFilter(double length) : bend_{0.0, length / 1000.0}, widest_(bend_.sigma) {}

  static constexpr double kShared = 10.0;
  /// How fast the estimate of before loses its worth: each second adds this, squared, to its variance. Over a
  /// quarter of an hour, in which a hold can be filled, that is a sigma of 3 cm. m / sqrt(s)
  static constexpr double kWander = 0.001;

  [[nodiscard]] const Bend& now() const { return bend_; }

  /// One frame's own estimate, without what was known before.
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
