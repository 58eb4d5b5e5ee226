// Which small motion brings points onto planes? The normal equations of robust point to plane least squares.
//
// Input: pairs of a point and a plane, one add() each. Output: solve().
// Residual of a pair: r = n . (p - c), with p the moving point, c and n the plane's centre and normal. A
// twist [rotation w; translation t] about `centre` changes r by (p - centre) x n . w + n . t (Chen & Medioni
// 1991). A bend of the map (bend.hpp) changes r by -rise * n_z.
// Weights for a kernel of k metres are those of Geman and McClure, (k^2 / (k^2 + r^2))^2: a pair whose
// residual is k counts a quarter.
// Rotations are about a point near the data: about a point 100 m away the condition would lose four digits.
// Any frame; metres, radians. Failure: directions of the pose that the pairs do not hold (free directions)
// are not moved along, and counted.
// Thread rule: a plain value. Cost: some 80 flops a pair, one small eigenproblem a solution.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "core/geometry/se3.hpp"

namespace hulltrack {

class PlaneSystem {
 public:
  using Vector7 = Eigen::Matrix<double, 7, 1>;  // rotation, translation, bend
  using Matrix7 = Eigen::Matrix<double, 7, 7>;

  /// Rotations are multiplied by this lever arm, about half a hatch, to compare them with translations, m.
  static constexpr double kLever = 10.0;
  /// A direction is free if its eigenvalue is smaller than that of this many pairs that face it squarely. So
  /// few pairs may all be of something that is not in the map.
  static constexpr double kFewestPairs = 10.0;
  /// 1 sigma of a return's distance from a plane of a map, m.
  static constexpr double kPairSigma = 0.02;
  /// Factor on standard deviations that come from sigma^2 H^-1. That covariance is too small, because
  /// neighbouring residuals share the map's errors: with a robust kernel a NEES/6 of 3 has been measured (the
  /// mean squared error is three times what the covariance says); 2^2 covers it.
  static constexpr double kInflation = 2.0;

  /// `centre`: a point near the data, m. `kernel`: m, > 0.
  PlaneSystem(const Eigen::Vector3d& centre, double kernel) : centre_(centre), kernel2_(kernel * kernel) {}

  /// A pair with residual r (m); p and n (unit) in one frame. `rise`: how much higher the bent map stands at
  /// p for each metre of bend.
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double r, double rise = 0.0) {
    add(jacobian(p, n, rise), r);
  }
  /// Adds a pair whose jacobian() is known; `returns`: of how many independent returns its residual is the
  /// mean.
  void add(const Vector7& j, double r, double returns = 1.0) {
    const double w = returns * weight_of(r);
    for (int row = 0; row < 7; ++row) {
      const double wj = w * j[row];
      for (int column = row; column < 7; ++column) {
        H_(row, column) += wj * j[column];
      }
      g_[row] -= wj * r;
    }
    weighted_squares_ += w * r * r;
    weight_ += w;
    ++pairs_;
  }

  struct Solution {
    Twist twist = Twist::Zero();  // about centre(), rad and m
    double bend = 0.0;            // change of the map's bend, m
    int free = 0;                 // number of free directions, of six (solve_shift(): of three)
  };
  /// Solves for pose and bend, with a bend known beforehand. `bend_information`: the variance of a pair over
  /// the variance of the known bend; infinite: the bend is not changed. `bend_off`: the present bend less the
  /// known one, m.
  [[nodiscard]] Solution solve(double bend_off, double bend_information) const;
  /// Solves for the pose; the bend is not changed. Directions that fewer pairs hold are free.
  [[nodiscard]] Solution solve(double fewest_pairs = kFewestPairs) const;
  /// Solves for a translation alone.
  [[nodiscard]] Solution solve_shift() const;

  /// Derivative of a residual by (rotation * kLever, translation, bend).
  [[nodiscard]] Vector7 jacobian(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double rise) const {
    Vector7 j;
    j << (p - centre_).cross(n) / kLever, n, -rise * n.z();
    return j;
  }
  /// How much a twist about centre() changes the residual of a pair with this jacobian(), m.
  [[nodiscard]] static double change(const Vector7& j, const Twist& twist) {
    return kLever * j.head<3>().dot(twist.head<3>()) + j.segment<3>(3).dot(twist.tail<3>());
  }
  [[nodiscard]] double weight_of(double r) const {
    const double share = kernel2_ / (kernel2_ + r * r);
    return share * share;
  }
  /// d (weight * r) / d r: what a pair with residual r adds to the curvature of the robust cost. Negative
  /// where |r| is above 0.58 of the kernel.
  [[nodiscard]] double slope_of(double r) const {
    const double share = kernel2_ / (kernel2_ + r * r);
    return share * share * (1.0 - 4.0 * (1.0 - share));
  }

  /// J^T W J for a twist [rotation; translation] about centre(), rad and m.
  [[nodiscard]] Matrix6 normal_matrix() const;

  [[nodiscard]] const Eigen::Vector3d& centre() const { return centre_; }
  [[nodiscard]] std::uint32_t pairs() const { return pairs_; }
  /// Weighted RMS of the residuals, m; 0 without pairs.
  [[nodiscard]] double rms() const { return weight_ > 0.0 ? std::sqrt(weighted_squares_ / weight_) : 0.0; }

 private:
  Eigen::Vector3d centre_;
  double kernel2_;
  Matrix7 H_ = Matrix7::Zero();  // sum of w j j^T, upper triangle
  Vector7 g_ = Vector7::Zero();  // sum of -w j r
  double weighted_squares_ = 0.0;
  double weight_ = 0.0;
  std::uint32_t pairs_ = 0;
};

/// The twist about `centre` as a transform of coordinates.
[[nodiscard]] Pose pose_from_twist_about(const Eigen::Vector3d& centre, const Twist& twist);

}  // namespace hulltrack
