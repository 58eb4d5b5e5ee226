// What the loader's operator asks of the ship: how much deeper, heeled, trimmed and farther along the quay
// does she lie than when her map was made, and how fast does that change?
//
// Metres, radians, seconds. Signs: draft + deeper; heel + the side at smaller Y of W down (roll); trim + the
// end at larger X down (pitch: by the head if the bow points that way, by the stern otherwise); surge + along
// the quay towards larger X. Only healthy poses count; without them the answers are empty.
// No clock, no failure. Thread rule: one owner. Cost: a few microseconds a frame.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "core/base/time.hpp"
#include "core/geometry/box.hpp"
#include "core/geometry/hull_pose.hpp"

namespace hulltrack {

/// How the ship lies against her map; as a rate: how much that changes in a second.
struct ShipMotion {
  double draft = 0.0;  // of the middle of the mapped ship, m
  double heel = 0.0;   // rad
  double trim = 0.0;   // rad
  double surge = 0.0;  // of the reference point, m
};

struct MotionProducts {
  std::optional<ShipMotion> now;   // this frame's; only from a healthy pose
  std::optional<ShipMotion> rate;  // per second, over the last minute of healthy poses
  double mapped_length = 0.0;      // of the ship along X, m: times trim it is the trim in m
};

class MotionGauge {
 public:
  static constexpr Nanoseconds kWindow = std::chrono::seconds(60);
  /// Healthy poses must span this for a rate. With 3 mm of noise at 10 Hz a draft rate then has a sigma of
  /// 0.2 m/h, (60 / 20)^1.5 times that of a full window. Ships load at 0.4 to 1.3 m/h.
  static constexpr Nanoseconds kShortest = std::chrono::seconds(20);
  static constexpr std::size_t kFewest = 20;  // poses: one for each second of kShortest
  /// After so long without a healthy pose the record begins anew. Across a gap of half of kShortest a slope
  /// would rest on the poses at its two ends, and the ship may have been moved meanwhile.
  static constexpr Nanoseconds kAway = std::chrono::seconds(10);

  /// The box of the mapped ship, in H, m.
  explicit MotionGauge(const Box& mapped_H);

  /// To be called with every frame. Poses without health are ignored.
  [[nodiscard]] MotionProducts update(MeasurementTime time, bool health, const HullPose& pose);

 private:
  struct Entry {
    MeasurementTime time;
    Eigen::Vector4d values;  // draft, heel, trim, surge
  };
  void forget(MeasurementTime now);
  [[nodiscard]] std::optional<ShipMotion> rate() const;

  Eigen::Vector3d middle_H_;
  double mapped_length_;
  std::deque<Entry> entries_;
};

}  // namespace hulltrack
