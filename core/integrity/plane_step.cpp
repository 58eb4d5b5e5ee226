#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/integrity/integrity.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kFewestObservations = 12;
constexpr int kSteps = 5;                // after three the result changes by less than 0.1 mm
constexpr double kKernel = 0.05;         // m: two to three sigma of a return's distance from a 5 cm map
constexpr double kSmallestSigma = 0.01;  // m: range noise of a LiDAR; robust_sigma() is never smaller
constexpr double kLength = 10.0;         // m: makes rotations comparable to translations; half a hatch

struct Normal {
  Matrix6 H = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
};

Vector6 jacobian(const SurfelObservation& o, const Eigen::Vector3d& centre) {
  Vector6 j;
  j << (o.p_W - centre).cross(o.n_W) / kLength, o.n_W;
  return j;
}

Normal accumulate(std::span<const SurfelObservation> observations, const Eigen::Vector3d& centre,
                  const Vector6& x) {
  Normal normal;
  for (const SurfelObservation& o : observations) {
    const Vector6 j = jacobian(o, centre);
    const double r = o.offset - j.dot(x);
    const double k2 = kKernel * kKernel;
    const double w = o.weight * k2 * k2 / ((k2 + r * r) * (k2 + r * r));
    normal.H.noalias() += w * j * j.transpose();
    normal.g.noalias() += w * o.offset * j;
  }
  return normal;
}

/// Sigma of one return: 1.4826 times the median absolute residual. Each residual is first multiplied by the
/// root of the number of returns that its mean is worth.
double robust_sigma(std::span<const SurfelObservation> observations, const Eigen::Vector3d& centre,
                    const Vector6& x) {
  std::vector<double> residuals;
  residuals.reserve(observations.size());
  for (const SurfelObservation& o : observations) {
    residuals.push_back(std::sqrt(o.weight) * std::abs(o.offset - jacobian(o, centre).dot(x)));
  }
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return std::max(kSmallestSigma, 1.4826 * *middle);
}

}  // namespace

PlaneStep solve_plane_step(std::span<const SurfelObservation> observations,
                           const Eigen::Vector3d& reference_W) {
  PlaneStep step;
  if (observations.size() < kFewestObservations) {
    return step;
  }
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const SurfelObservation& o : observations) {
    centre += o.p_W;
  }
  centre /= static_cast<double>(observations.size());

  Vector6 x = Vector6::Zero();  // [rotation * kLength; translation] about the centroid
  Matrix6 H;
  for (int i = 0; i < kSteps; ++i) {
    const Normal normal = accumulate(observations, centre, x);
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(normal.H, Eigen::EigenvaluesOnly);
    if (!(eigen.eigenvalues()[0] > 1e-6 * eigen.eigenvalues()[5])) {
      return step;
    }
    x = normal.H.ldlt().solve(normal.g);
    H = normal.H;
  }
  const double sigma = PlaneSystem::kInflation * robust_sigma(observations, centre, x);
  Eigen::DiagonalMatrix<double, 6> scale;
  scale.diagonal() << Eigen::Vector3d::Constant(1.0 / kLength), Eigen::Vector3d::Ones();
  const Matrix6 covariance = scale * (sigma * sigma * H.inverse()) * scale;

  Eigen::Matrix<double, 3, 6> to_reference;
  to_reference << -skew(reference_W - centre), Eigen::Matrix3d::Identity();
  step.solved = true;
  step.rotation = x.head<3>() / kLength;
  step.translation = to_reference * (scale * x);
  step.covariance_translation = to_reference * covariance * to_reference.transpose();
  step.covariance_rotation = covariance.topLeftCorner<3, 3>();
  return step;
}

}  // namespace hulltrack
