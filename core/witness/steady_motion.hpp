// For how long have the machine's joints stood, or moved as they do?
//
// Metres, radians, by JointName. Thread rule: a plain value. No failure.
#pragma once

#include <optional>

#include "core/base/time.hpp"
#include "core/witness/machine_wear.hpp"

namespace hulltrack {

[[nodiscard]] inline Eigen::Vector3d rate_of(const MachineStand& stand) {
  return {stand.rate.d_x, stand.rate.theta_r, stand.rate.theta_p};
}
/// Which joints move at these speeds, m/s and rad/s.
[[nodiscard]] inline Eigen::Array<bool, 3, 1> moving(const Eigen::Vector3d& rate) {
  return rate.array().abs() > kStandsBelow.array();
}

class SteadyMotion {
 public:
  /// So long after a change all observations are of the machine as it stands or moves now. They are up to 1 s
  /// old (10 frames at 10 Hz), and a boom swings out for a while: half as long again.
  static constexpr Nanoseconds kSettled = std::chrono::milliseconds(1500);

  /// Once a frame.
  void note(MeasurementTime time, const MachineStand& stand) {
    const Eigen::Vector3d rate = rate_of(stand);
    const bool stands = !moving(rate).any();
    const bool the_same = since_ && stands == !moving(rate_).any() && (stands || !moving(rate - rate_).any());
    if (!the_same) {
      since_ = time;
      rate_ = rate;
    }
  }
  /// The joints stand, or move at the same speed, for kSettled.
  [[nodiscard]] bool is_settled(MeasurementTime time) const { return since_ && time - *since_ >= kSettled; }
  [[nodiscard]] bool stands() const { return !moving(rate_).any(); }

 private:
  std::optional<MeasurementTime> since_;
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // when it began
};

}  // namespace hulltrack
