#include "core/map/plane_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hulltrack {

PlaneFit fit_plane(const Point& p, std::span<const Point> neighbours) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();   // xx, yy, zz
  Eigen::Vector3d products = Eigen::Vector3d::Zero();  // yz, zx, xy
  for (const Point& neighbour : neighbours) {
    const Eigen::Vector3d d = (neighbour - p).cast<double>();
    sum += d;
    squares += d.cwiseProduct(d);
    products += Eigen::Vector3d(d.y() * d.z(), d.z() * d.x(), d.x() * d.y());
  }
  Eigen::Matrix3d moments;
  moments << squares.x(), products.z(), products.y(),  //
      products.z(), squares.y(), products.x(),         //
      products.y(), products.x(), squares.z();
  const double n = static_cast<double>(neighbours.size());
  PlaneFit fit;
  fit.centroid = sum / n;
  const Eigen::Matrix3d covariance = moments / n - fit.centroid * fit.centroid.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  fit.normal = solver.eigenvectors().col(0);
  for (std::size_t i = 0; i < fit.spread.size(); ++i) {
    fit.spread[i] = std::sqrt(std::max(0.0, solver.eigenvalues()[static_cast<Eigen::Index>(i)]));
  }
  return fit;
}

}  // namespace hulltrack
