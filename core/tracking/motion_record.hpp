// How fast is the hull moving? The slope of its latest poses, so that noise does not trip the limit.
//
// Positions of the reference point in W, m, and roll, pitch, yaw, rad; a plain value of bounded size. Pure.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "core/base/time.hpp"

namespace hulltrack {

class MotionRecord {
 public:
  /// A slope over a window tells the speed in its middle. 0.7 s lag by 0.35 s, which with one frame period
  /// keeps within half a second; at 10 Hz and 3 cm of noise its sigma is 0.046 m/s.
  static constexpr Nanoseconds kWindow = std::chrono::milliseconds(700);
  static constexpr std::size_t kFewest = 4;
  static constexpr Nanoseconds kShortest = std::chrono::milliseconds(300);

  struct Motion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s
    Eigen::Vector3d rpy_rate = Eigen::Vector3d::Zero();  // rad/s
  };

  /// Times must not run backwards (an earlier pose restarts the record). Angles stay far from +-180 deg.
  void add(MeasurementTime time, const Eigen::Vector3d& position, const Eigen::Vector3d& rpy) {
    if (!poses_.empty() && time <= poses_.back().time) {
      poses_.clear();
    }
    poses_.push_back({time, (Vector6() << position, rpy).finished()});
    while (time - poses_.front().time > kWindow) {
      poses_.pop_front();
    }
  }

  /// Least squares slope; nothing while fewer than kFewest poses span kShortest.
  [[nodiscard]] std::optional<Motion> motion() const {
    if (poses_.size() < kFewest || poses_.back().time - poses_.front().time < kShortest) {
      return std::nullopt;
    }
    double mean_t = 0.0;
    for (const Entry& e : poses_) {
      mean_t += since_first(e) / static_cast<double>(poses_.size());
    }
    double tt = 0.0;
    Vector6 tp = Vector6::Zero();
    for (const Entry& e : poses_) {
      const double t = since_first(e) - mean_t;
      tt += t * t;
      tp += t * e.pose;
    }
    return Motion{tp.head<3>() / tt, tp.tail<3>() / tt};
  }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  struct Entry {
    MeasurementTime time;
    Vector6 pose;  // position, roll, pitch, yaw
  };
  [[nodiscard]] double since_first(const Entry& e) const { return to_seconds(e.time - poses_.front().time); }

  std::deque<Entry> poses_;
};

}  // namespace hulltrack
