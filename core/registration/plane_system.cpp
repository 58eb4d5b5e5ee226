#include "core/registration/plane_system.hpp"

#include <Eigen/Eigenvalues>

namespace hulltrack {
namespace {

Twist unscaled(Twist twist) {
  twist.head<3>() /= PlaneSystem::kLever;
  return twist;
}

}  // namespace

PlaneSystem::Solution PlaneSystem::solve() const {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(Matrix6(H_.selfadjointView<Eigen::Upper>()));
  Solution solution{Twist::Zero(), 0};
  for (int i = 0; i < 6; ++i) {
    const double worth = eigen.eigenvalues()[i];
    if (!(worth >= kFewestPairs)) {
      ++solution.free;
      continue;
    }
    const Twist direction = eigen.eigenvectors().col(i);
    solution.twist += direction.dot(g_) / worth * direction;
  }
  solution.twist = unscaled(solution.twist);
  return solution;
}

Matrix6 PlaneSystem::normal_matrix() const {
  Twist scale;
  scale << Eigen::Vector3d::Constant(kLever), Eigen::Vector3d::Ones();
  return scale.asDiagonal() * Matrix6(H_.selfadjointView<Eigen::Upper>()) * scale.asDiagonal();
}

Pose pose_from_twist_about(const Eigen::Vector3d& centre, const Twist& twist) {
  Pose T = Pose::Identity();
  T.linear() = so3_exp(twist.head<3>());
  T.translation() = centre + twist.tail<3>() - T.linear() * centre;
  return T;
}

}  // namespace hulltrack
