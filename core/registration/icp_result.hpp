// What an alignment came to: shared by the point to point and the point to plane registration.
//
// Frames: `source` is what was moved, `target` what stood still; metres, radians. Plain values.
#pragma once

#include <cstdint>

#include "core/geometry/se3.hpp"

namespace hulltrack {

enum class IcpStop {
  converged,            // the last increment was below both epsilons
  iteration_limit,      // it was not, after max_iterations
  too_few_matches,      // fewer than three source points have a target point within the gate
  degenerate_geometry,  // the matched points leave every motion, or a rotation, free
  invalid_start,        // the start pose is not finite
};

/// One clause for a log line.
[[nodiscard]] const char* describe(IcpStop stop);

/// Figures are those of the last iteration's search, that is before its increment; zeros if it matched
/// nothing.
struct IcpResult {
  Pose T_target_source = Pose::Identity();  // the last good estimate, also when not converged
  bool converged = false;                   // stop == IcpStop::converged
  IcpStop stop = IcpStop::invalid_start;
  int iterations = 0;             // searches made
  std::uint32_t matched = 0;      // source points with a target point within the gate
  double rms_residual = 0.0;      // of the matched distances, m
  double mean_residual = 0.0;     // of the matched distances, m
  double last_translation = 0.0;  // of the last increment, m
  double last_rotation = 0.0;     // of the last increment, rad

  int free_directions = 0;  // of the six that the pairs do not hold; not moved along

  /// J^T W J of the matched pairs against a twist [rotation; translation] of the source about `centre`, in
  /// the target's frame: rad, m; weights are 1 where no kernel says otherwise.
  Matrix6 normal_matrix = Matrix6::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // centroid of the matched source points, target frame, m
};

}  // namespace hulltrack
