// By how much is the sensor not where joints and mounts put it, as far as the quay tells?
//
// E = T_W_L as reported * (T_W_L true)^-1 moves what stands still in W to where the scan puts it. Robust
// least squares over observations of the quay gives its twist [rotation; translation] about a point near
// them, and that only along the directions that they hold: of a quay's top alone these are three of six.
// Every direction is a measurement of its own, with a sigma that does not depend on the others'. Frame W,
// metres, radians. Pure. Failure: no directions. Cost: 0.1 us an observation and step, some 40 us.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/geometry/se3.hpp"
#include "core/quay/quay_observer.hpp"

namespace hulltrack {

struct Misplacement {
  /// `direction` . twist(E) = offset, give or take sigma; m.
  struct Measurement {
    Twist direction;
    double offset;
    double sigma;
  };

  /// What all of a quay's map or top shares, m: it was made with a machine whose axes were as well known as
  /// this one's are at best, 5 mm and, over the lever of PlaneSystem, 0.03 deg.
  static constexpr double kShared = 0.005;

  Eigen::Vector3d centre_W = Eigen::Vector3d::Zero();  // what the twist is about
  Twist twist = Twist::Zero();                         // along the directions held, nothing along the others
  std::vector<Measurement> measured;                   // six when all axes are held
  std::uint32_t observations = 0;
  std::uint32_t agreeing = 0;  // of them: within 10 cm of where the twist puts them
  /// The twist about another point. Meaningful where all directions are held.
  [[nodiscard]] Twist about(const Eigen::Vector3d& point_W) const {
    return about_point(point_W - centre_W, twist);
  }
  /// Whether this is where the twist puts it, give or take 10 cm.
  [[nodiscard]] bool agrees(const QuayObservation& o) const;
  static constexpr std::size_t kDirections = 6;
  [[nodiscard]] bool holds_all() const { return measured.size() == kDirections; }
};

[[nodiscard]] Misplacement find_misplacement(std::span<const QuayObservation> observations);

}  // namespace hulltrack
