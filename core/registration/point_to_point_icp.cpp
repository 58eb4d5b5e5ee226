#include "core/registration/point_to_point_icp.hpp"

#include <cassert>
#include <cmath>

#include "core/registration/rigid_fit.hpp"

namespace hulltrack {
namespace {

// The sums of one iteration's pairs.
struct Sums {
  RigidFit fit;
  double distance = 0.0;
  double squared_distance = 0.0;

  explicit Sums(std::span<const Correspondence> pairs)
      : fit(pairs.empty() ? Eigen::Vector3d::Zero() : pairs.front().target) {
    for (const Correspondence& pair : pairs) {
      fit.add(pair.source, pair.target);
      distance += pair.distance;
      squared_distance += pair.distance * pair.distance;
    }
  }
};

void report(const Sums& sums, IcpResult& result) {
  result.matched = sums.fit.pairs();
  if (result.matched == 0) {
    result.rms_residual = result.mean_residual = 0.0;
    result.normal_matrix.setZero();
    return;
  }
  result.rms_residual = std::sqrt(sums.squared_distance / result.matched);
  result.mean_residual = sums.distance / result.matched;
  result.normal_matrix = sums.fit.normal_matrix();
  result.centre = sums.fit.centroid();
}

}  // namespace

PointToPointIcp::PointToPointIcp(const IcpConfig& config)
    : config_(config), correspondences_(config.max_correspondence_distance) {
  assert(config.max_iterations >= 1 && config.max_correspondence_distance > 0.0);
}

IcpResult PointToPointIcp::align(std::span<const Point> source, const KdTree& target, const Pose& T_init) {
  IcpResult result;
  if (!T_init.matrix().allFinite()) {
    return result;
  }
  result.T_target_source = T_init;
  result.stop = IcpStop::iteration_limit;
  correspondences_.reset(source, target);
  while (result.iterations < config_.max_iterations) {
    const Sums sums(correspondences_.find(result.T_target_source));
    ++result.iterations;
    report(sums, result);
    const std::optional<RigidTransform> increment = sums.fit.solve();
    if (!increment) {
      result.stop = result.matched < 3 ? IcpStop::too_few_matches : IcpStop::degenerate_geometry;
      break;
    }
    result.T_target_source = increment->pose() * result.T_target_source;
    result.last_translation = increment->translation.norm();
    result.last_rotation = rotation_angle(increment->rotation);
    if (result.last_translation < config_.translation_epsilon &&
        result.last_rotation < config_.rotation_epsilon) {
      result.stop = IcpStop::converged;
      result.converged = true;
      break;
    }
  }
  return result;
}

}  // namespace hulltrack
