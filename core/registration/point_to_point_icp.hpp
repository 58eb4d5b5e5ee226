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
#include "core/kdtree/kdtree.hpp"
#include "core/registration/correspondence_cache.hpp"
#include "core/registration/icp_result.hpp"

namespace hulltrack {

/// Defaults: Guo 2025, 2.3.
struct IcpConfig {
  double max_correspondence_distance = 0.3;  // m, > 0
  int max_iterations = 50;                   // >= 1
  double translation_epsilon = 0.001;        // m
  double rotation_epsilon = radians(0.1);    // rad
};

class PointToPointIcp {
 public:
  explicit PointToPointIcp(const IcpConfig& config);

  /// Moves `source` onto `target`, starting with T_init.
  ///
  /// The size of an increment (|dT - I| of 2.3 f) is its angle and the shift of the matched points' centroid:
  /// an epsilon of 1 mm then means 1 mm of the hull. The translation column of dT is not used. It is the
  /// shift of the frame's origin, where 0.01 deg and a lever arm of 100 m already make 17 mm.
  [[nodiscard]] IcpResult align(std::span<const Point> source, const KdTree& target, const Pose& T_init);

 private:
  IcpConfig config_;
  CorrespondenceCache correspondences_;
};

}  // namespace hulltrack
