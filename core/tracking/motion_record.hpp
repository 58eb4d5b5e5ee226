// How fast is the hull moving? The slope of its latest positions, so that noise does not trip the limit.
//
// Positions of the reference point in W, m; a plain value of bounded size. Pure.
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

  /// Times must not run backwards (an earlier position restarts the record).
  void add(MeasurementTime time, const Eigen::Vector3d& position) {
    if (!poses_.empty() && time <= poses_.back().time) {
      poses_.clear();
    }
    poses_.push_back({time, position});
    while (time - poses_.front().time > kWindow) {
      poses_.pop_front();
    }
  }

  /// Least squares slope, m/s; nothing while fewer than kFewest positions span kShortest.
  [[nodiscard]] std::optional<Eigen::Vector3d> velocity() const {
    if (poses_.size() < kFewest || poses_.back().time - poses_.front().time < kShortest) {
      return std::nullopt;
    }
    double mean_t = 0.0;
    for (const Entry& e : poses_) {
      mean_t += since_first(e) / static_cast<double>(poses_.size());
    }
    double tt = 0.0;
    Eigen::Vector3d tp = Eigen::Vector3d::Zero();
    for (const Entry& e : poses_) {
      const double t = since_first(e) - mean_t;
      tt += t * t;
      tp += t * e.position;
    }
    return tp / tt;
  }

 private:
  struct Entry {
    MeasurementTime time;
    Eigen::Vector3d position;
  };
  [[nodiscard]] double since_first(const Entry& e) const { return to_seconds(e.time - poses_.front().time); }

  std::deque<Entry> poses_;
};

}  // namespace hulltrack
