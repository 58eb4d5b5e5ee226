#include "core/map/plane_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hulltrack {

PlaneFit fit_plane(const Point& p, const std::vector<Neighbour>& neighbours, const Cloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Neighbour& neighbour : neighbours) {
    const Eigen::Vector3d d = (cloud[neighbour.index] - p).cast<double>();
    sum += d;
    squares += d * d.transpose();
  }
  const double n = static_cast<double>(neighbours.size());
  PlaneFit fit;
  fit.centroid = sum / n;
  const Eigen::Matrix3d covariance = squares / n - fit.centroid * fit.centroid.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  fit.normal = solver.eigenvectors().col(0);
  for (std::size_t i = 0; i < fit.spread.size(); ++i) {
    fit.spread[i] = std::sqrt(std::max(0.0, solver.eigenvalues()[static_cast<Eigen::Index>(i)]));
  }
  return fit;
}

}  // namespace hulltrack
