// Where does a cloud fit into the map? Iterative closest point, point to point (Guo 2025, 2.3 b to f).
//
// Each iteration: nearest target point within the gate for every source point (b, c), the rigid increment
// dT of least squares by SVD (d), T <- dT * T (e), stop when dT is small (f). The source is thinned before
// (a: VoxelFilter). Frames: source points in any frame, the target tree's frame in the answer; m, rad.
// Failure: states in the result, never an exception, never a NaN; source points that are not finite are
// ignored. Thread rule: one owner; scratch memory is kept between calls. Cost: about one search a source
// point and a few ns a source point and iteration (see CorrespondenceCache).
#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"
#include "core/registration/correspondence_cache.hpp"
#include "core/search/kdtree.hpp"

namespace hulltrack {

/// Defaults: Guo 2025, 2.3.
struct IcpConfig {
  double max_correspondence_distance = 0.3;  // m, > 0
  int max_iterations = 50;                   // >= 1
  double translation_epsilon = 0.001;        // m
  double rotation_epsilon = radians(0.1);    // rad
};

enum class IcpStop {
  converged,            // the last increment was below both epsilons
  iteration_limit,      // it was not, after max_iterations
  too_few_matches,      // fewer than three source points have a target point within the gate
  degenerate_geometry,  // the matched points lie on one line: a rotation is free
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

  /// J^T J of the matched pairs against a twist [rotation; translation] of the source about `centre`, in
  /// the target's frame: rad, m, unit weights.
  Matrix6 normal_matrix = Matrix6::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // centroid of the matched source points, target frame, m
};

class PointToPointIcp {
 public:
  explicit PointToPointIcp(const IcpConfig& config);

  /// Moves `source` onto `target`, starting with T_init.
  ///
  /// The size of an increment (|dT - I| of 2.3 f) is its angle and the displacement of the matched points'
  /// centroid, so that "1 mm" speaks of the hull: the translation column of dT is that of the
  /// world's origin, where 0.01 deg and a 100 m lever arm already make 17 mm.
  [[nodiscard]] IcpResult align(std::span<const Point> source, const KdTree& target, const Pose& T_init);

 private:
  IcpConfig config_;
  CorrespondenceCache correspondences_;
};

}  // namespace hulltrack
