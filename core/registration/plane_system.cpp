#include "core/registration/plane_system.hpp"

#include <Eigen/Eigenvalues>

namespace hulltrack {
namespace {

/// x = H^-1 g along H's eigenvectors with an eigenvalue of `fewest` or more; returns how many have less.
template <int N>
int solve_held(const Eigen::Matrix<double, N, N>& H, const Eigen::Matrix<double, N, 1>& g,
               Eigen::Matrix<double, N, 1>& x, double fewest = PlaneSystem::kFewestPairs) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> eigen(H);
  int free = 0;
  for (int i = 0; i < N; ++i) {
    const double eigenvalue = eigen.eigenvalues()[i];
    if (!(eigenvalue >= fewest)) {
      ++free;
      continue;
    }
    const Eigen::Matrix<double, N, 1> direction = eigen.eigenvectors().col(i);
    x += direction.dot(g) / eigenvalue * direction;
  }
  return free;
}

}  // namespace

PlaneSystem::Solution PlaneSystem::solve(double bend_off, double bend_information) const {
  if (!std::isfinite(bend_information)) {
    return solve();
  }
  // The bend is eliminated (Schur complement). Parts of the ship far from the reference point then count less
  // for the pose, because a bend can explain their residuals as well.
  const Matrix6 H_pp = H_.topLeftCorner<6, 6>().selfadjointView<Eigen::Upper>();
  const Twist h_pb = H_.topRightCorner<6, 1>();
  const double h_bb = H_(6, 6) + bend_information;
  const double g_b = g_[6] - bend_information * bend_off;
  Solution solution;
  if (!(h_bb > 0.0)) {
    return solve();
  }
  solution.free = solve_held<6>(H_pp - h_pb * h_pb.transpose() / h_bb, g_.head<6>() - h_pb * (g_b / h_bb),
                                solution.twist);
  solution.bend = (g_b - h_pb.dot(solution.twist)) / h_bb;
  solution.twist.head<3>() /= kLever;
  return solution;
}

PlaneSystem::Solution PlaneSystem::solve(double fewest_pairs) const {
  Solution solution;
  solution.free = solve_held<6>(H_.topLeftCorner<6, 6>().selfadjointView<Eigen::Upper>(), g_.head<6>(),
                                solution.twist, fewest_pairs);
  solution.twist.head<3>() /= kLever;
  return solution;
}

PlaneSystem::Solution PlaneSystem::solve_shift() const {
  Solution solution;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d H = H_.block<3, 3>(3, 3).selfadjointView<Eigen::Upper>();
  solution.free = solve_held<3>(H, g_.segment<3>(3), shift);
  solution.twist.tail<3>() = shift;
  return solution;
}

Matrix6 PlaneSystem::normal_matrix() const {
  Twist scale;
  scale << Eigen::Vector3d::Constant(kLever), Eigen::Vector3d::Ones();
  return scale.asDiagonal() * Matrix6(H_.topLeftCorner<6, 6>().selfadjointView<Eigen::Upper>()) *
         scale.asDiagonal();
}

Pose pose_from_twist_about(const Eigen::Vector3d& centre, const Twist& twist) {
  return pose_about(centre, so3_exp(twist.head<3>()), twist.tail<3>());
}

}  // namespace hulltrack
