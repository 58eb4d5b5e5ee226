#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/integrity/integrity.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {
namespace {

constexpr std::size_t kFewestObservations = 12;
constexpr int kSteps = 5;                // after three the result changes by less than 0.1 mm
constexpr double kKernel = 0.05;         // m: two to three sigma of a return's distance from a 5 cm map
constexpr double kSmallestSigma = 0.01;  // m: range noise of a LiDAR; robust_sigma() is never smaller
// A direction is free if its eigenvalue is smaller than this share of the largest.
constexpr double kFree = 1e-6;

/// What is left of an observation's offset after a twist about the system's centre, m.
double residual(const PlaneSystem& system, const SurfelObservation& o, const Twist& twist) {
  return o.offset - PlaneSystem::change(system.jacobian(o.p_W, o.n_W, 0.0), twist);
}

/// The normal equations at a twist.
PlaneSystem system_at(std::span<const SurfelObservation> observations, const Eigen::Vector3d& centre,
                      const Twist& twist) {
  PlaneSystem system(centre, kKernel);
  for (const SurfelObservation& o : observations) {
    system.add(system.jacobian(o.p_W, o.n_W, 0.0), residual(system, o, twist), o.weight);
  }
  return system;
}

bool leaves_a_direction_free(const PlaneSystem& system) {
  Twist in_metres;  // rotations times the lever
  in_metres << Eigen::Vector3d::Constant(1.0 / PlaneSystem::kLever), Eigen::Vector3d::Ones();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(
      in_metres.asDiagonal() * system.normal_matrix() * in_metres.asDiagonal(), Eigen::EigenvaluesOnly);
  return !(eigen.eigenvalues()[0] > kFree * eigen.eigenvalues()[5]);
}

/// Sigma of one return: 1.4826 times the median absolute residual. Each residual is first multiplied by the
/// root of the number of returns of which it is the mean.
double robust_sigma(std::span<const SurfelObservation> observations, const PlaneSystem& system,
                    const Twist& twist) {
  std::vector<double> residuals;
  residuals.reserve(observations.size());
  for (const SurfelObservation& o : observations) {
    residuals.push_back(std::sqrt(o.weight) * std::abs(residual(system, o, twist)));
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

  Twist twist = Twist::Zero();  // of the hull, about the centroid
  Matrix6 H;
  for (int i = 0; i < kSteps; ++i) {
    const PlaneSystem system = system_at(observations, centre, twist);
    if (leaves_a_direction_free(system)) {
      return step;
    }
    // All directions are solved for: far off its planes a good pose has small weights, and few pairs by them.
    // The solution moves returns onto planes; the step moves planes to where the returns are.
    twist -= system.solve(0.0).twist;
    H = system.normal_matrix();
  }
  const double sigma =
      PlaneSystem::kInflation * robust_sigma(observations, PlaneSystem(centre, kKernel), twist);
  const Matrix6 covariance = sigma * sigma * H.inverse();
  Eigen::Matrix<double, 3, 6> to_reference;
  to_reference << -skew(reference_W - centre), Eigen::Matrix3d::Identity();
  step.solved = true;
  step.rotation = twist.head<3>();
  step.translation = to_reference * twist;
  step.covariance_translation = to_reference * covariance * to_reference.transpose();
  step.covariance_rotation = covariance.topLeftCorner<3, 3>();
  return step;
}

}  // namespace hulltrack
