#include "core/registration/plane_system.hpp"

#include <Eigen/Eigenvalues>

namespace hulltrack {
namespace {

/// x = H^-1 g along the directions that are held; returns how many are not.
template <int N>
int solve_held(const Eigen::Matrix<double, N, N>& H, const Eigen::Matrix<double, N, 1>& g,
               Eigen::Matrix<double, N, 1>& x) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> eigen(H);
  int free = 0;
  for (int i = 0; i < N; ++i) {
    const double worth = eigen.eigenvalues()[i];
    if (!(worth >= PlaneSystem::kFewestPairs)) {
      ++free;
      continue;
    }
    const Eigen::Matrix<double, N, 1> direction = eigen.eigenvectors().col(i);
    x += direction.dot(g) / worth * direction;
  }
  return free;
}

}  // namespace

PlaneSystem::Solution PlaneSystem::solve() const {
  Solution solution{Twist::Zero(), 0};
  solution.free = solve_held<6>(H_.selfadjointView<Eigen::Upper>(), g_, solution.twist);
  solution.twist.head<3>() /= kLever;
  return solution;
}

PlaneSystem::Solution PlaneSystem::solve_shift() const {
  Solution solution{Twist::Zero(), 0};
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d H = H_.bottomRightCorner<3, 3>().selfadjointView<Eigen::Upper>();
  solution.free = solve_held<3>(H, g_.tail<3>(), shift);
  solution.twist.tail<3>() = shift;
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
