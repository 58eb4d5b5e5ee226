// Which small motion brings points onto planes? The normal equations of robust point to plane least squares.
//
// Residual of a pair: r = n . (p - c), with p the moving point, c and n the plane's; a twist [rotation;
// translation] about `centre` changes it by (p - centre) x n . w + n . t (Chen & Medioni 1991). Weights are
// Geman and McClure's for a kernel of k metres: (k^2 / (k^2 + r^2))^2, so that a pair k off counts a quarter.
// Linearised about a point near the data: a lever arm of 100 m would cost four digits of the condition.
// Any frame; metres, radians. Failure: directions that the pairs leave free are not moved along, and counted.
// Thread rule: a plain value. Cost: some 60 flops a pair, one 6 x 6 eigenproblem a solution.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "core/geometry/se3.hpp"

namespace hulltrack {

class PlaneSystem {
 public:
  /// Makes rotations comparable to translations: at this lever arm, about half a hatch, a turn moves points
  /// as far as a shift does. m
  static constexpr double kLever = 10.0;
  /// A direction held by less than this many pairs that face it squarely is free: any few of them may be of
  /// something that is not in the map.
  static constexpr double kFewestPairs = 10.0;

  /// `centre`: a point near the data, m. `kernel`: m, > 0.
  PlaneSystem(const Eigen::Vector3d& centre, double kernel) : centre_(centre), kernel2_(kernel * kernel) {}

  /// A pair with residual r (m); p and n (unit) in one frame.
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double r) {
    const double share = kernel2_ / (kernel2_ + r * r);
    const double w = share * share;
    const Eigen::Vector3d turn = (p - centre_).cross(n) / kLever;
    const double j[6] = {turn.x(), turn.y(), turn.z(), n.x(), n.y(), n.z()};
    for (int row = 0; row < 6; ++row) {
      const double wj = w * j[row];
      for (int column = row; column < 6; ++column) {
        H_(row, column) += wj * j[column];
      }
      g_[row] -= wj * r;
    }
    weighted_squares_ += w * r * r;
    weight_ += w;
    ++pairs_;
  }

  struct Solution {
    Twist twist;   // about centre(), rad and m
    int free = 0;  // directions of the six that were not moved along
  };
  [[nodiscard]] Solution solve() const;
  /// The same without a rotation; `free` counts the directions of three.
  [[nodiscard]] Solution solve_shift() const;

  /// J^T W J against [rotation; translation] about centre(): rad, m.
  [[nodiscard]] Matrix6 normal_matrix() const;

  [[nodiscard]] const Eigen::Vector3d& centre() const { return centre_; }
  [[nodiscard]] std::uint32_t pairs() const { return pairs_; }
  [[nodiscard]] double weight() const { return weight_; }
  /// Of the weighted residuals, m; 0 without pairs.
  [[nodiscard]] double rms() const { return weight_ > 0.0 ? std::sqrt(weighted_squares_ / weight_) : 0.0; }

 private:
  Eigen::Vector3d centre_;
  double kernel2_;
  Matrix6 H_ = Matrix6::Zero();  // upper triangle, rotations in units of 1 / kLever
  Twist g_ = Twist::Zero();
  double weighted_squares_ = 0.0;
  double weight_ = 0.0;
  std::uint32_t pairs_ = 0;
};

/// The twist about `centre` as a transform of coordinates.
[[nodiscard]] Pose pose_from_twist_about(const Eigen::Vector3d& centre, const Twist& twist);

}  // namespace hulltrack
