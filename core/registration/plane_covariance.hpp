// How sure is a point to plane fit? Its covariance from the residuals themselves.
//
// sigma^2 H^-1 promises too much: neighbouring residuals share the errors of the map, of mixed pixels and of
// what lies on a deck. So the residuals are summed patch by patch and the spread of these sums is measured
// (the sandwich estimator of robust regression, Huber 1967, with clusters as Liang and Zeger 1986):
// A^-1 (sum over patches of s s^T) A^-1, with s a patch's sum of weight * residual * Jacobian and A the
// curvature of the robust cost. Whatever is independent between patches is in it, whatever its cause.
// Frame and units as PlaneSystem. Thread rule: one owner, scratch is kept. Cost: 60 ns a pair.
#pragma once

#include <cstdint>
#include <vector>

#include "core/registration/bend.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {

/// Both about the system's centre, [rotation; translation], rad and m.
struct PlaneCovariance {
  bool valid = false;  // false: too few patches, or a direction is free
  Matrix6 pose = Matrix6::Zero();
  /// The bend from this fit alone: how far it is from the one that the residuals were taken with, m.
  double bend_off = 0.0;
  double bend_sigma = 0.0;  // m; 0 = the fit says nothing about the bend
};

class PlaneCovarianceEstimator {
 public:
  /// Patches that a spread can be judged from: the estimate's own uncertainty triples it.
  static constexpr double kFewestPatches = 20.0;

  void reset(std::uint32_t patches);
  void add(const PlaneSystem& system, std::uint32_t patch, const Eigen::Vector3d& p, const Eigen::Vector3d& n,
           double r, double rise);

  /// `known`: what the bend was taken as, and how sure that was.
  [[nodiscard]] PlaneCovariance estimate(const Bend& known) const;

 private:
  [[nodiscard]] double patches_of_equal_worth() const;

  PlaneSystem::Matrix7 A_ = PlaneSystem::Matrix7::Zero();
  std::vector<PlaneSystem::Vector7> sums_;  // per patch
  std::vector<std::uint32_t> touched_;      // patches with a pair
  std::vector<std::uint32_t> pairs_;        // per patch
};

}  // namespace hulltrack
