// How fast is the hull moving now? A parabola is fitted to the poses of the last 1.5 s; its slope at the
// newest pose is the speed. So noise does not trip the speed limit, and a hull that sets off is soon seen.
//
// Positions of the reference point in W, m, and roll, pitch, yaw, rad; a plain value of bounded size. Pure.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "core/base/time.hpp"

namespace hulltrack {

struct HullSpeed {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s
  Eigen::Vector3d rpy_rate = Eigen::Vector3d::Zero();  // rad/s
};

/// A straight line would give the speed in the middle of the window: for a ship that sets off, the speed of
/// half a window ago. A parabola gives the speed at the newest pose, exactly if the acceleration is steady.
class HullSpeedRecord {
 public:
  /// The record holds the poses of this last stretch of time, 16 at 10 Hz.
  /// Noise: if each pose has noise s, the speed has a sigma of s * 2.0 Hz: 6 mm/s for 3 mm, and 25 mm/s for
  /// 12.5 mm, a quarter of the 5 cm that health allows.
  /// Delay: at 0.05 m/s2 a ship's speed is three sigma (18 mm/s) after 0.36 s, and a frame later it is seen.
  /// Lag: if the acceleration begins within the window, however fierce, the answer is at most 0.19 of the
  /// window (0.28 s) late; if it ends there, the answer is as much ahead.
  /// Swing: a ship that swings seems too fast, by 11 % for a period of 8 s, by 1 % for 30 s.
  static constexpr Nanoseconds kWindow = std::chrono::milliseconds(1500);
  /// After a longer gap the record begins anew: the speed would rest on what lies at the two ends of the gap.
  static constexpr Nanoseconds kLongestGap = kWindow / 2;
  static constexpr std::size_t kFewest = 4;
  static constexpr Nanoseconds kShortest = std::chrono::milliseconds(300);

  /// A pose that is not later than the last one, or comes after a gap, begins the record anew. Angles stay
  /// far from +-180 deg.
  void add(MeasurementTime time, const Eigen::Vector3d& position, const Eigen::Vector3d& rpy) {
    if (!poses_.empty() && (time <= poses_.back().time || time - poses_.back().time > kLongestGap)) {
      poses_.clear();
    }
    poses_.push_back({time, (Vector6() << position, rpy).finished()});
    while (time - poses_.front().time > kWindow) {
      poses_.pop_front();
    }
  }

  /// The speed at the time of the last pose; nothing while fewer than kFewest poses or less than kShortest.
  [[nodiscard]] std::optional<HullSpeed> speed() const {
    if (poses_.size() < kFewest || poses_.back().time - poses_.front().time < kShortest) {
      return std::nullopt;
    }
    const auto n = static_cast<double>(poses_.size());
    double mean_t = 0.0;
    for (const Entry& e : poses_) {
      mean_t += since_first(e) / n;
    }
    double tt = 0.0;
    double ttt = 0.0;
    Vector6 tp = Vector6::Zero();
    for (const Entry& e : poses_) {
      const double t = since_first(e) - mean_t;
      tt += t * t;
      ttt += t * t * t;
      tp += t * e.pose;
    }
    // Least squares of a parabola in two parts that are orthogonal over these times: a line, and a part q.
    double qq = 0.0;
    Vector6 qp = Vector6::Zero();
    for (const Entry& e : poses_) {
      const double t = since_first(e) - mean_t;
      const double q = t * t - ttt / tt * t - tt / n;
      qq += q * q;
      qp += q * e.pose;
    }
    const double last_t = since_first(poses_.back()) - mean_t;
    const Vector6 rate = tp / tt + (2.0 * last_t - ttt / tt) * qp / (qq + kBentByNoise);
    return HullSpeed{rate.head<3>(), rate.tail<3>()};
  }

 private:
  /// Added to the denominator of the curvature, so that few poses give a line and many a parabola: noise
  /// bends a short record more than a ship's engines or tugs do. (2 s / a)^2 weighs the two by Bayes' rule,
  /// for noise s of 3 mm and accelerations a of 0.05 m/s2. Four poses make a line, a full window a parabola
  /// to 2 %. From the first answer on, the speed's noise stays below 4.5 Hz times a pose's, and its lag below
  /// 0.2 s.
  static constexpr double kBentByNoise = 0.0144;  // s^4

  using Vector6 = Eigen::Matrix<double, 6, 1>;
  struct Entry {
    MeasurementTime time;
    Vector6 pose;  // position, roll, pitch, yaw
  };
  [[nodiscard]] double since_first(const Entry& e) const { return to_seconds(e.time - poses_.front().time); }

  std::deque<Entry> poses_;
};

}  // namespace hulltrack
