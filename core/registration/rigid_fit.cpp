#include "core/registration/rigid_fit.hpp"

#include <Eigen/SVD>

namespace hulltrack {
namespace {

// The points lie on a line, and a rotation is free, if the second singular value of their covariance is at
// most this share of the first: 1e-10 of a variance is 1e-5 of a length, a millimetre in a hundred metres.
constexpr double kLine = 1e-10;

}  // namespace

Pose RigidTransform::pose() const { return pose_about(centre, rotation, translation); }

Eigen::Vector3d RigidFit::centroid() const { return origin_ + sum_p_ / pairs_; }

std::optional<RigidTransform> RigidFit::solve() const {
  if (pairs_ < 3) {
    return std::nullopt;
  }
  const Eigen::Vector3d mean_p = sum_p_ / pairs_;
  const Eigen::Vector3d mean_m = sum_m_ / pairs_;
  const Eigen::Matrix3d covariance = sum_pm_ - pairs_ * mean_p * mean_m.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& spread = svd.singularValues();
  if (!(spread(1) > kLine * spread(0))) {
    return std::nullopt;
  }
  // If the best orthogonal matrix is a mirror image, the last axis is reversed to make it a rotation.
  const double handedness = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d signs(1.0, 1.0, handedness);
  return RigidTransform{svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose(), mean_m - mean_p,
                        origin_ + mean_p};
}

Matrix6 RigidFit::normal_matrix() const {
  const Eigen::Vector3d mean = sum_p_ / pairs_;
  const Eigen::Matrix3d scatter = sum_pp_ - pairs_ * mean * mean.transpose();
  Matrix6 H = Matrix6::Zero();
  // Sum of -[p]x [p]x = |p|^2 I - p p^T about the centroid, where rotation and translation decouple.
  H.topLeftCorner<3, 3>() = scatter.trace() * Eigen::Matrix3d::Identity() - scatter;
  H.bottomRightCorner<3, 3>() = pairs_ * Eigen::Matrix3d::Identity();
  return H;
}

}  // namespace hulltrack
