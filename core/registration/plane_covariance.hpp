// How sure is a point to plane fit? Its covariance from the residuals themselves.
//
// The sandwich estimator of robust regression (Huber 1967): A^-1 B A^-1, with A the curvature of the robust
// cost and B = sum of s s^T over pairs, s = weight * residual * Jacobian. It promises too much: neighbouring
// residuals share the errors of the map, of mixed pixels and of what lies on a deck. So the s are also summed
// patch by patch, and B of these sums (clusters as Liang and Zeger 1986) tells how much is shared. A frame
// has too few patches for a matrix of its own, but the ratio of the two, one number, is a property of ship
// and sensor that frames have in common: the caller keeps a mean of it. Frame and units as PlaneSystem.
// Thread rule: one owner, scratch is kept. Cost: 60 ns a pair.
#pragma once

#include <cstdint>
#include <vector>

#include "core/registration/bend.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {

/// Both about the system's centre, [rotation; translation], rad and m.
struct PlaneCovariance {
  bool valid = false;              // false: too few patches, or a direction is free
  Matrix6 pose = Matrix6::Zero();  // as if all residuals were independent
  double shared = 1.0;             // mean ratio of what patches say to that, over the six directions; noisy
  Twist by_bend = Twist::Zero();   // minus what a metre of bend moves the pose by
  /// The bend from this fit alone: how far it is from the one that the residuals were taken with, m.
  double bend_off = 0.0;
  double bend_sigma = 0.0;  // m; 0 = the fit says nothing about the bend
};

class PlaneCovarianceEstimator {
 public:
  /// Patches that a ratio can be judged from: six are what the fit takes up.
  static constexpr std::size_t kFewestPatches = 12;

  void reset(std::uint32_t patches);
  void add(const PlaneSystem& system, std::uint32_t patch, const Eigen::Vector3d& p, const Eigen::Vector3d& n,
           double r, double rise);

  [[nodiscard]] PlaneCovariance estimate() const;

 private:
  PlaneSystem::Matrix7 A_ = PlaneSystem::Matrix7::Zero();
  PlaneSystem::Matrix7 B_ = PlaneSystem::Matrix7::Zero();
  std::vector<PlaneSystem::Vector7> sums_;  // per patch
  std::vector<std::uint32_t> touched_;      // patches with a pair
  std::vector<std::uint32_t> pairs_;        // per patch
};

}  // namespace hulltrack
