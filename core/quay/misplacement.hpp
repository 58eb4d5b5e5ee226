// By how much is the sensor not where joints and mounts put it, as far as the quay tells?
//
// The misplacement is E = T_W_L as reported * (T_W_L true)^-1: it moves what stands still in W to where the
// scan puts it. Input: observations of the quay (quay_observer.hpp). Output: the twist [rotation;
// translation] of E about a point near them, by robust least squares. Only directions that the observations
// hold are measured; the quay's top alone holds three of six. Each has a sigma of its own, which does not
// depend on the others. Frame W, metres, radians. Pure. Failure: no measured directions. Cost: 0.1 us an
// observation and step, some 40 us.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/geometry/se3.hpp"
#include "core/quay/quay_observer.hpp"

namespace hulltrack {

struct Misplacement {
  /// direction . twist of E = offset, with standard deviation sigma; m.
  struct Measurement {
    Twist direction;
    double offset;
    double sigma;
  };

  /// Error that the whole map or top may have, added to every sigma in quadrature, m. It was made with a
  /// machine whose axes were known no better than this: 5 mm and, over PlaneSystem::kLever, 0.03 deg.
  static constexpr double kShared = 0.005;

  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();  // what the twist is about
  Twist twist = Twist::Zero();                         // of E; 0 along directions that are not held
  std::vector<Measurement> measured;                   // one for each direction that is held: six at most
  std::uint32_t observations = 0;
  std::uint32_t agreeing = 0;  // observations within 10 cm of where the twist puts them
  /// The twist about another point. Meaningful where all directions are held.
  [[nodiscard]] Twist about(const Eigen::Vector3d& point_W) const {
    return about_point(point_W - centre_W, twist);
  }
  /// Whether the observation is within 10 cm of where the twist puts it.
  [[nodiscard]] bool agrees(const QuayObservation& o) const;
  /// E itself, as far as it is known.
  [[nodiscard]] Pose pose() const { return pose_about(centre_W, so3_exp(twist.head<3>()), twist.tail<3>()); }
  /// The twists about centre_W of which nothing is measured, one for each direction that is not held: of 1 m,
  /// or of a turn that moves as much at the lever of PlaneSystem.
  [[nodiscard]] std::vector<Twist> unheld() const;
  static constexpr std::size_t kDirections = 6;
  [[nodiscard]] bool holds_all() const { return measured.size() == kDirections; }
};

[[nodiscard]] Misplacement find_misplacement(std::span<const QuayObservation> observations);

}  // namespace hulltrack
