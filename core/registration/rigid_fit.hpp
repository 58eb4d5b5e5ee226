// Which rigid motion brings points closest to their partners? Least squares in closed form.
//
// Kabsch's solution by singular value decomposition (Umeyama 1991 without scale; Guo 2025, 2.3 d), from sums
// that are collected pair by pair in double. The sums are about an origin near the data, so that large
// coordinates cost no digits. Any frame, metres.
// Failure: no motion for fewer than three pairs, or for pairs on one line, which leave a rotation free.
// Thread rule: a plain value. Cost: some 30 flops a pair, one 3 x 3 SVD.
#pragma once

#include <cstdint>
#include <optional>

#include "core/geometry/se3.hpp"

namespace hulltrack {

/// A motion p -> rotation * (p - centre) + centre + translation: the translation is that of `centre`.
struct RigidTransform {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;  // m
  Eigen::Vector3d centre;       // m

  /// The same motion as a transform of coordinates.
  [[nodiscard]] Pose pose() const;
};

class RigidFit {
 public:
  /// `origin`: any point near the data, m.
  explicit RigidFit(const Eigen::Vector3d& origin) : origin_(origin) {}

  /// `moving` is to be brought to `fixed`; both finite.
  void add(const Eigen::Vector3d& moving, const Eigen::Vector3d& fixed) {
    const Eigen::Vector3d p = moving - origin_;
    const Eigen::Vector3d m = fixed - origin_;
    ++pairs_;
    sum_p_ += p;
    sum_m_ += m;
    sum_pm_ += p * m.transpose();
    sum_pp_ += p * p.transpose();
  }

  [[nodiscard]] std::uint32_t pairs() const { return pairs_; }

  /// Mean of the moving points, m. Precondition: pairs() > 0.
  [[nodiscard]] Eigen::Vector3d centroid() const;

  /// The best motion, with the moving points' centroid as its centre; nothing if a rotation is free.
  [[nodiscard]] std::optional<RigidTransform> solve() const;

  /// J^T J of the residuals `moving - fixed` for a twist [rotation; translation] of the moving points about
  /// centroid(), rad and m. Its inverse times the residuals' variance (m^2) is the covariance of the motion,
  /// if the residuals are independent. Precondition: pairs() > 0.
  [[nodiscard]] Matrix6 normal_matrix() const;

 private:
  Eigen::Vector3d origin_;
  std::uint32_t pairs_ = 0;
  Eigen::Vector3d sum_p_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_m_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d sum_pm_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d sum_pp_ = Eigen::Matrix3d::Zero();
};

}  // namespace hulltrack
