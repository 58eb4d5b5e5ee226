// Which small motion brings points onto planes? The normal equations of robust point to plane least squares.
//
// Residual of a pair: r = n . (p - c), with p the moving point, c and n the plane's. A twist [rotation;
// translation] about `centre` changes it by (p - centre) x n . w + n . t (Chen & Medioni 1991), a bend of the
// map (bend.hpp) by -rise * n_z. Weights are Geman and McClure's for a kernel of k metres:
// (k^2 / (k^2 + r^2))^2, so that a pair k off counts a quarter. Linearised about a point near the data: a
// lever arm of 100 m would cost four digits of the condition.
// Any frame; metres, radians. Failure: directions that the pairs leave free are not moved along, and counted.
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

  /// Makes rotations comparable to translations: at this lever arm, about half a hatch, a turn moves points
  /// as far as a shift does. m
  static constexpr double kLever = 10.0;
  /// A direction held by less than this many pairs that face it squarely is free: any few of them may be of
  /// something that is not in the map.
  static constexpr double kFewestPairs = 10.0;
  /// Of a return against a plane of a map, m.
  static constexpr double kPairSigma = 0.02;
  /// sigma^2 H^-1 of scan matching is overconfident, because neighbouring residuals share the map's errors:
  /// NEES/6 of 3 has been measured with a robust kernel; 2^2 covers it.
  static constexpr double kInflation = 2.0;

  /// `centre`: a point near the data, m. `kernel`: m, > 0.
  PlaneSystem(const Eigen::Vector3d& centre, double kernel) : centre_(centre), kernel2_(kernel * kernel) {}

  /// A pair with residual r (m); p and n (unit) in one frame. `rise`: of the bent map at p for each metre of
  /// bend.
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double r, double rise = 0.0) {
    add(jacobian(p, n, rise), r);
  }
  /// The same of a pair whose jacobian() is known.
  void add(const Vector7& j, double r) {
    const double w = weight_of(r);
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
    int free = 0;                 // directions of the six (of solve_shift(): three) that were not moved along
  };
  /// `bend_worth`: what is known of the bend besides, as 1 / m^2 in units of a pair's variance, and
  /// `bend_off`: by how much the present bend is above that, m. Infinite worth: the bend stays.
  [[nodiscard]] Solution solve(double bend_off, double bend_worth) const;
  /// The bend stays.
  [[nodiscard]] Solution solve() const;
  /// Neither a rotation nor a bend.
  [[nodiscard]] Solution solve_shift() const;

  /// d r / d (rotation * kLever, translation, bend).
  [[nodiscard]] Vector7 jacobian(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double rise) const {
    Vector7 j;
    j << (p - centre_).cross(n) / kLever, n, -rise * n.z();
    return j;
  }
  [[nodiscard]] double weight_of(double r) const {
    const double share = kernel2_ / (kernel2_ + r * r);
    return share * share;
  }
  /// d (weight * r) / d r: what a residual of r contributes to the curvature of the robust cost.
  [[nodiscard]] double slope_of(double r) const {
    const double share = kernel2_ / (kernel2_ + r * r);
    return share * share * (1.0 - 4.0 * (1.0 - share));
  }

  /// J^T W J against [rotation; translation] about centre(): rad, m.
  [[nodiscard]] Matrix6 normal_matrix() const;

  [[nodiscard]] const Eigen::Vector3d& centre() const { return centre_; }
  [[nodiscard]] std::uint32_t pairs() const { return pairs_; }
  /// Of the weighted residuals, m; 0 without pairs.
  [[nodiscard]] double rms() const { return weight_ > 0.0 ? std::sqrt(weighted_squares_ / weight_) : 0.0; }

 private:
  Eigen::Vector3d centre_;
  double kernel2_;
  Matrix7 H_ = Matrix7::Zero();  // upper triangle, rotations in units of 1 / kLever
  Vector7 g_ = Vector7::Zero();
  double weighted_squares_ = 0.0;
  double weight_ = 0.0;
  std::uint32_t pairs_ = 0;
};

/// The twist about `centre` as a transform of coordinates.
[[nodiscard]] Pose pose_from_twist_about(const Eigen::Vector3d& centre, const Twist& twist);

}  // namespace hulltrack
