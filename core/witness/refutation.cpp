#include "core/witness/refutation.hpp"

#include <cmath>

#include "core/witness/steady_motion.hpp"

namespace hulltrack {

bool refutes(const JointDoubt& left, double charged) {
  return left.reads_too_much / charged + left.hidden / std::abs(charged) < 1.0;
}

bool refutes(const WrongLatency& charged, const MachineSight& sight, const Misplacement& at_rest) {
  const bool the_same_move = (moving(rate_of(sight.stand)) || !moving(charged.rate)).all();
  return the_same_move &&
         refutes(doubt_latency(sight.machine, sight.stand, sight.seen, at_rest), charged.older);
}

bool refutes(const WrongPlace& charged, const MachineSight& sight, const std::vector<Twist>& of_reference,
             const std::function<bool(const Twist&)>& misses) {
  // now(twist, point_W): the twist of the charged place as the error of today, about a point.
  const auto is_gone = [&](const auto& now) {
    std::vector<Twist> unsure = of_reference;
    for (const Twist& twist : charged.unheld) {
      unsure.push_back(now(twist, sight.seen.centre_W));
    }
    const Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();
    return refutes(doubt_twist(sight.machine, sight.stand, sight.seen, now(charged.off, sight.seen.centre_W),
                               unsure)) &&
           (!charged.beyond_gate || misses(now(charged.off, origin_W)));
  };
  return is_gone([&](const Twist& off, const Eigen::Vector3d& point_W) {
           const Twist carried = carried_by_boom(sight.machine, charged.stand, sight.stand, off);
           return about_point(point_W - sight.stand.sensor_W, carried);
         }) &&
         is_gone([&](const Twist& off, const Eigen::Vector3d& point_W) {
           return about_point(point_W - charged.stand.sensor_W, off);
         });
}

}  // namespace hulltrack
