// The result of an alignment, for both point to point and point to plane registration.
//
// Frames: `source` is the cloud that was moved, `target` what stood still; metres, radians. Plain values.
#pragma once

#include <cstdint>

#include "core/geometry/se3.hpp"

namespace hulltrack {

enum class IcpStop {
  converged,            // the last increment was below both epsilons
  iteration_limit,      // after max_iterations the last increment was still too large
  too_few_matches,      // point to point: fewer than three pairs; point to plane: no direction is held
  degenerate_geometry,  // point to point only: the pairs leave a rotation free
  invalid_start,        // the start pose is not finite
};

/// One clause for a log line.
[[nodiscard]] const char* describe(IcpStop stop);

/// `matched`, residuals, `normal_matrix` and `centre` belong to the pose before the last increment and to the
/// pairs of the last search. Without pairs all but `centre` are zero.
struct IcpResult {
  Pose T_target_source = Pose::Identity();  // the last good estimate, also when not converged
  bool converged = false;                   // stop == IcpStop::converged
  IcpStop stop = IcpStop::invalid_start;
  int iterations = 0;             // searches made
  std::uint32_t matched = 0;      // pairs that counted in the fit
  double rms_residual = 0.0;      // of the pairs' distances, m; point to plane: weighted, from the planes
  double mean_residual = 0.0;     // of the pairs' distances, m; point to plane: always 0
  double last_translation = 0.0;  // size of the last increment, m
  double last_rotation = 0.0;     // size of the last increment, rad

  int free_directions = 0;  // how many of the six the pairs do not hold; the pose is not moved along them

  /// Information of the pairs, J^T W J, for a twist [rotation; translation] of the source about `centre`, in
  /// the target's frame; rad, m. Its inverse times the residuals' variance is the covariance of the fit, if
  /// the residuals are independent. Weights W come from the robust kernel; without one they are 1.
  Matrix6 normal_matrix = Matrix6::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // centroid of the paired source points, target frame, m
};

}  // namespace hulltrack
