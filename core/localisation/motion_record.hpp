// How fast is the hull moving now? The slope of its latest poses at the last of them, so that noise does not
// trip the limit and a hull that sets off is not seen late.
//
// Positions of the reference point in W, m, and roll, pitch, yaw, rad; a plain value of bounded size. Pure.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "core/base/time.hpp"

namespace hulltrack {

/// A line through the poses tells the speed in the middle of their time: of a ship that sets off, what it was
/// half a window ago. A parabola tells it at the end, whatever the acceleration as long as it is steady.
class MotionRecord {
 public:
  /// 16 poses at 10 Hz, each with noise s, leave a speed with a sigma of s * 2.0 Hz: 6 mm/s for 3 mm, 25 mm/s
  /// for 12.5 mm, a quarter of the 5 cm that health allows. So of a ship that speeds up by 0.05 m/s2 three
  /// sigma and a frame period are 0.46 s. One that sets off within the window, however fiercely, is seen 0.19
  /// of the window late at most, 0.28 s; one that stops speeding up looks ahead by as much. A swing looks
  /// faster than it is, by 11 % at 8 s, by 1 % at 30 s.
  static constexpr Nanoseconds kWindow = std::chrono::milliseconds(1500);
  /// Across a longer gap the speed would rest on what lies at its two ends.
  static constexpr Nanoseconds kLongestGap = kWindow / 2;
  static constexpr std::size_t kFewest = 4;
  static constexpr Nanoseconds kShortest = std::chrono::milliseconds(300);

  struct Motion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s
    Eigen::Vector3d rpy_rate = Eigen::Vector3d::Zero();  // rad/s
  };

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

  /// At the time of the last pose; nothing while fewer than kFewest poses span kShortest.
  [[nodiscard]] std::optional<Motion> motion() const {
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
    // Least squares by parts that do not depend on each other: a line, and what a parabola q adds to it.
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
    return Motion{rate.head<3>(), rate.tail<3>()};
  }

 private:
  /// Noise bends a short record more than a ship's engines or tugs do. (2 s / a)^2 weighs the two by Bayes'
  /// rule, for noise s of 3 mm and accelerations a of 0.05 m/s2: four poses make a line, a full window a
  /// parabola to 2 %. So from the first answer on the noise stays below 4.5 Hz times that of a pose, and the
  /// lag below 0.2 s.
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
