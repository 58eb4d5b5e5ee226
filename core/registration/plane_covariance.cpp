#include "core/registration/plane_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace hulltrack {
namespace {

using Vector7 = PlaneSystem::Vector7;
using Matrix7 = PlaneSystem::Matrix7;

// The fit itself takes up as many patches as it has parameters (n - 6 are left to judge by), and errors measured
// by a covariance that is itself estimated from m patches look larger by m / (m - 7) (Hotelling's T-squared).
constexpr double kParameters = 6.0;

Twist scale() {
  Twist s;
  s << Eigen::Vector3d::Constant(1.0 / PlaneSystem::kLever), Eigen::Vector3d::Ones();
  return s;
}

}  // namespace

void PlaneCovarianceEstimator::reset(std::uint32_t patches) {
  for (const std::uint32_t patch : touched_) {
    sums_[patch].setZero();
    pairs_[patch] = 0;
  }
  touched_.clear();
  sums_.resize(patches, Vector7::Zero());
  pairs_.resize(patches, 0);
  A_.setZero();
}

void PlaneCovarianceEstimator::add(const PlaneSystem& system, std::uint32_t patch, const Eigen::Vector3d& p,
                                   const Eigen::Vector3d& n, double r, double rise) {
  const Vector7 j = system.jacobian(p, n, rise);
  A_.noalias() += system.slope_of(r) * j * j.transpose();
  sums_[patch] -= system.weight_of(r) * r * j;
  if (pairs_[patch]++ == 0) {
    touched_.push_back(patch);
  }
}

/// As many patches with equally many pairs would scatter like these (Kish's effective sample size).
double PlaneCovarianceEstimator::patches_of_equal_worth() const {
  double sum = 0.0;
  double squares = 0.0;
  for (const std::uint32_t patch : touched_) {
    sum += pairs_[patch];
    squares += static_cast<double>(pairs_[patch]) * pairs_[patch];
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

PlaneCovariance PlaneCovarianceEstimator::estimate(const Bend& known) const {
  PlaneCovariance out;
  const double n = patches_of_equal_worth();
  if (!(n >= kFewestPatches)) {
    return out;
  }
  const Matrix6 A = A_.topLeftCorner<6, 6>();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(A);
  if (!(eigen.eigenvalues()[0] >= 0.2 * PlaneSystem::kFewestPairs)) {
    return out;
  }
  const Matrix6 A_inverse = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                            eigen.eigenvectors().transpose();
  const Twist by_bend = A_inverse * A_.topRightCorner<6, 1>();  // by how much a metre of bend moves the pose
  const double bend_curvature = A_(6, 6) - A_.topRightCorner<6, 1>().dot(by_bend);
  Matrix6 spread = Matrix6::Zero();
  double bend_spread = 0.0;
  double bend_sum = 0.0;
  for (const std::uint32_t patch : touched_) {
    const Vector7& s = sums_[patch];
    spread.noalias() += s.head<6>() * s.head<6>().transpose();
    const double bend = s[6] - by_bend.dot(s.head<6>());
    bend_spread += bend * bend;
    bend_sum += bend;
  }
  const double fitted = n / (n - kParameters - (kParameters + 1.0));
  out.valid = true;
  out.pose = fitted * A_inverse * spread * A_inverse;
  out.pose += known.sigma * known.sigma * by_bend * by_bend.transpose();
  out.pose = scale().asDiagonal() * out.pose * scale().asDiagonal();
  if (bend_curvature > 1e-3) {
    out.bend_off = bend_sum / bend_curvature;
    out.bend_sigma = std::sqrt(fitted * bend_spread) / bend_curvature;
  }
  return out;
}

}  // namespace hulltrack
