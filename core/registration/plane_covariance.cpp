#include "core/registration/plane_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace hulltrack {
namespace {

using Vector7 = PlaneSystem::Vector7;
using Matrix7 = PlaneSystem::Matrix7;

Twist scale() {
  Twist s;
  s << Eigen::Vector3d::Constant(1.0 / PlaneSystem::kLever), Eigen::Vector3d::Ones();
  return s;
}

}  // namespace

void PlaneCovarianceEstimator::reset(std::uint32_t clusters) {
  for (const std::uint32_t cluster : touched_) {
    sums_[cluster].setZero();
    pairs_[cluster] = 0;
  }
  touched_.clear();
  sums_.resize(clusters, Vector7::Zero());
  pairs_.resize(clusters, 0);
  A_.setZero();
  B_.setZero();
}

void PlaneCovarianceEstimator::add(const PlaneSystem& system, std::uint32_t cluster, const Eigen::Vector3d& p,
                                   const Eigen::Vector3d& n, double r, double rise) {
  const Vector7 j = system.jacobian(p, n, rise);
  A_.noalias() += system.slope_of(r) * j * j.transpose();
  const Vector7 s = -system.weight_of(r) * r * j;
  B_.noalias() += s * s.transpose();
  sums_[cluster] += s;
  if (pairs_[cluster]++ == 0) {
    touched_.push_back(cluster);
  }
}

PlaneCovariance PlaneCovarianceEstimator::estimate() const {
  constexpr double kParameters = 6.0;  // each takes up one degree of freedom: n - 6 are left of n clusters
  PlaneCovariance out;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(Matrix6(A_.topLeftCorner<6, 6>()));
  // The robust cost curves less than a sum of squares: only pairs within about half a kernel add curvature.
  // So a fifth of kFewestPairs is enough.
  if (touched_.size() < kFewestClusters || !(eigen.eigenvalues()[0] >= 0.2 * PlaneSystem::kFewestPairs)) {
    return out;
  }
  const Matrix6 A_inverse = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                            eigen.eigenvectors().transpose();
  const Twist by_bend = A_inverse * A_.topRightCorner<6, 1>();
  Vector7 bend_alone;  // times a sum of s: what is left for the bend once the pose has adapted
  bend_alone << -by_bend, 1.0;
  Matrix6 B_clusters = Matrix6::Zero();
  double bend_spread = 0.0;
  double bend_sum = 0.0;
  for (const std::uint32_t cluster : touched_) {
    const Vector7& s = sums_[cluster];
    B_clusters.noalias() += s.head<6>() * s.head<6>().transpose();
    const double bend = bend_alone.dot(s);
    bend_spread += bend * bend;
    bend_sum += bend;
  }
  const auto n = static_cast<double>(touched_.size());
  const Matrix6 B = B_.topLeftCorner<6, 6>();
  out.valid = true;
  out.shared = n / (n - kParameters) * (B.ldlt().solve(B_clusters)).trace() / 6.0;
  out.pose = scale().asDiagonal() * (A_inverse * B * A_inverse) * scale().asDiagonal();
  out.by_bend = scale().asDiagonal() * by_bend;
  const double bend_curvature = bend_alone.dot(A_.col(6));
  // With less than a thousandth of what a pair at the hull's end tells, the bend's sigma is 2 cm (kPairSigma)
  // over the root of that, 0.6 m: more than any hull bends.
  constexpr double kLeastCurvature = 1e-3;
  if (bend_curvature > kLeastCurvature) {
    out.bend_off = bend_sum / bend_curvature;
    out.bend_sigma = std::sqrt(n / (n - kParameters) * bend_spread) / bend_curvature;
  }
  return out;
}

}  // namespace hulltrack
