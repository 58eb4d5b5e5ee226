// Where does a cloud fit onto the flat parts of the map? Iterative closest point, point to plane.
//
// Each round: the nearest plane's centre for every source point within the gate, then two Gauss-Newton steps
// (plane_system.hpp) with these pairs. A pair counts if the point lies beside the centre by no more than
// planes are apart: beyond that the surface may have ended. The robust kernel narrows from round to round, so
// that what is not in the map (cargo, rain, a moved cover) pulls less and less.
// Frames: source points in any frame, the planes' frame in the answer; m, rad. Failure: states in the result,
// never an exception, never a NaN; source points that are not finite are ignored.
// Thread rule: one owner; scratch memory is kept between calls. Cost: 2 ms for 7,000 points.
#pragma once

#include <span>

#include "core/geometry/cloud.hpp"
#include "core/map/plane_map.hpp"
#include "core/registration/bend.hpp"
#include "core/registration/correspondence_cache.hpp"
#include "core/registration/icp_result.hpp"
#include "core/registration/plane_covariance.hpp"
#include "core/registration/plane_system.hpp"

namespace hulltrack {

struct PlaneIcpConfig {
  int max_iterations = 50;              // rounds, >= 1
  double translation_epsilon = 0.0002;  // m, of the matched points' centroid
  double rotation_epsilon = radians(0.002);
};

struct PlaneIcpResult {
  IcpResult icp;
  double bend = 0.0;           // of the hull as this fit and what was known before have it, m
  PlaneCovariance covariance;  // about icp.centre, in the map's axes
};

/// How well a pose explains a cloud, from the nearest planes alone.
struct PlaneScore {
  double worth = 0.0;  // sum of k^2 / (k^2 + r^2) over points on a plane, k = PointToPlaneIcp::kScoreKernel
  std::uint32_t points = 0;  // points looked at
};

class PointToPlaneIcp {
 public:
  /// Farther than this from a centre, across the normal, a point is not of its plane, m: half the diagonal
  /// of a voxel and a margin for centres that lie off its middle.
  static constexpr double kBesides = 1.1 * PlaneMap::kSpacing;
  static constexpr double kGate = 0.5;         // m: of fine alignment, from the nearest centre
  static constexpr double kScoreKernel = 0.1;  // m

  PointToPlaneIcp(const PlaneIcpConfig& config, const BendShape& shape);

  /// Fine alignment: from a start some 0.3 m or less off. `bend`: what is known of it.
  [[nodiscard]] PlaneIcpResult align(std::span<const Point> source, const PlaneMap& map, const Pose& T_init,
                                     const Bend& bend);

  /// Coarse alignment: from a start up to 0.5 m and 1 deg off to within the reach of align(), with few
  /// points.
  [[nodiscard]] Pose approach(std::span<const Point> source, const PlaneMap& map, const Pose& T_init);

  [[nodiscard]] PlaneScore score(std::span<const Point> source, const PlaneMap& map, const Pose& T);

 private:
  struct Estimate {
    Pose T;  // since the search
    double bend;
  };
  template <typename Visit>
  void for_each_pair(std::span<const Correspondence> pairs, const PlaneMap& map, const Estimate& at,
                     Visit&& visit) const;
  [[nodiscard]] PlaneSystem system_of(std::span<const Correspondence> pairs, const PlaneMap& map,
                                      const Estimate& at, double kernel) const;
  [[nodiscard]] PlaneCovariance covariance_of(std::span<const Correspondence> pairs, const PlaneMap& map,
                                              const Estimate& at);
  void move(std::span<const Point> source, const Pose& T);

  PlaneIcpConfig config_;
  BendShape shape_;
  CorrespondenceCache correspondences_;
  Cloud moved_;
  std::vector<Neighbour> nearest_;
  PlaneCovarianceEstimator estimator_;
};

}  // namespace hulltrack
