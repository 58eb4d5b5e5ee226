// What the loader's operator asks of the ship: how much deeper, heeled, trimmed and along the quay does she
// lie than when her map was made, and how fast does that change?
//
// Metres, radians, seconds. Signs: draft + deeper; heel + the side at smaller Y of W down (roll); trim + the
// end at larger X down (pitch: by the head if the bow points that way, by the stern otherwise); surge + along
// the quay towards larger X. Nothing is known without healthy poses, and that is said as nothing.
// No clock, no failure. Thread rule: one owner. Cost: a few microseconds a frame.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "core/base/time.hpp"
#include "core/geometry/box.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

/// Against the map, or the same a second.
struct ShipMotion {
  double draft = 0.0;  // of the middle of the mapped ship, m
  double heel = 0.0;   // rad
  double trim = 0.0;   // rad
  double surge = 0.0;  // of the reference point, m
};

struct MotionProducts {
  std::optional<ShipMotion> now;   // this frame's; only from a healthy pose
  std::optional<ShipMotion> rate;  // a second, over the last minute of healthy poses
  double mapped_length = 0.0;      // what a trim in metres is read over, m
};

class MotionGauge {
 public:
  static constexpr Nanoseconds kWindow = std::chrono::seconds(60);
  /// A third of the window: by then the pose's noise of 3 mm at 10 Hz, the weights below and (60 / 20)^1.5
  /// leave a draft rate within 0.2 m/h (1 sigma), where ships load at 0.4 to 1.3 m/h.
  static constexpr Nanoseconds kShortest = std::chrono::seconds(20);
  static constexpr std::size_t kFewest = 20;  // one a second of kShortest
  /// Healthy poses further apart than half of kShortest would let a slope rest on its two ends, and a ship
  /// that was out of sight that long may have been moved: the record begins anew.
  static constexpr Nanoseconds kAway = std::chrono::seconds(10);

  /// The box of the mapped ship, in H, m.
  explicit MotionGauge(const Box& mapped_H);

  /// To be called with every frame. `displacement` of the reference point, `rpy` of T_W_H; not looked at
  /// without health.
  [[nodiscard]] MotionProducts update(MeasurementTime time, bool health, const Eigen::Vector3d& displacement,
                                      const Eigen::Vector3d& rpy, const Pose& T_W_H);

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
