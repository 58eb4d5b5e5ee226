// How sure is a point to plane fit? Its covariance, from the residuals themselves.
//
// Input: the pairs of a fit, one add() each. Output: estimate().
// The covariance is the sandwich estimator of robust regression (Huber 1967), A^-1 B A^-1. A is the curvature
// of the robust cost. B is the sum of s s^T over pairs, with s = weight * residual * Jacobian.
// This takes residuals as independent and comes out too small: neighbouring residuals share the errors of the
// map, of mixed pixels and of what lies on a deck. So the s are also summed over each cluster (the planes of
// one class in a cube, PlaneMap::kClusterSize), and a second B is formed from these sums (clusters as in
// Liang and Zeger 1986). `shared` is the ratio of the second B to the first. A frame has too few clusters for
// a second covariance. The ratio, one number, is a property of ship and sensor: the caller averages it over
// frames and multiplies the covariance by it.
// Frame and units as PlaneSystem. Failure: valid = false with too few clusters or a free direction.
// Thread rule: one owner, scratch memory is kept. Cost: 60 ns a pair.
#pragma once

#include <cstdint>
#include <vector>

#include "core/registration/bend.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {

/// Pose and twist about the system's centre, [rotation; translation], rad and m.
struct PlaneCovariance {
  bool valid = false;              // false: too few clusters, or a direction is free
  Matrix6 pose = Matrix6::Zero();  // covariance, as if all residuals were independent
  double shared = 1.0;             // variance by clusters over that by pairs, mean of six directions; noisy
  Twist by_bend = Twist::Zero();   // the pose moves by -by_bend for each metre that the bend is changed
  /// The bend that this fit alone would give, less the bend that the residuals were taken with, m.
  double bend_off = 0.0;
  double bend_sigma = 0.0;  // 1 sigma of that bend, m; 0 = the fit says nothing about the bend
};

class PlaneCovarianceEstimator {
 public:
  /// With pairs in fewer clusters there is no estimate: the fit's six parameters take up six of them.
  static constexpr std::size_t kFewestClusters = 12;

  /// Starts anew; pairs are of clusters with numbers below `clusters`.
  void reset(std::uint32_t clusters);
  /// A pair of the cluster: point p, the plane's normal n, residual r (m), rise as in PlaneSystem::add().
  void add(const PlaneSystem& system, std::uint32_t cluster, const Eigen::Vector3d& p,
           const Eigen::Vector3d& n, double r, double rise);

  [[nodiscard]] PlaneCovariance estimate() const;

 private:
  PlaneSystem::Matrix7 A_ = PlaneSystem::Matrix7::Zero();
  PlaneSystem::Matrix7 B_ = PlaneSystem::Matrix7::Zero();
  std::vector<PlaneSystem::Vector7> sums_;  // per cluster: sum of s
  std::vector<std::uint32_t> touched_;      // clusters with a pair
  std::vector<std::uint32_t> pairs_;        // per cluster: how many pairs
};

}  // namespace hulltrack
