// Where does a cloud fit onto the flat parts of the map? Iterative closest point, point to plane.
//
// A round of align() pairs every source point with the plane whose centre is nearest, within kGate. It then
// makes two Gauss-Newton steps (plane_system.hpp) with these pairs. A pair counts only if its point lies
// within kBesides of the centre, measured in the plane: farther off the surface may have ended. The robust
// kernel narrows over the first rounds, so that what is not in the map (cargo, rain, a moved cover) pulls
// less and less.
// Frames: source points in any frame, the answer takes them to the planes' frame; m, rad. Failure: states in
// the result, never an exception, never a NaN; source points that are not finite are ignored.
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
  int max_iterations = 50;                   // rounds, >= 1
  double translation_epsilon = 0.0002;       // m, of the matched points' centroid
  double rotation_epsilon = radians(0.002);  // rad
};

struct PlaneIcpResult {
  IcpResult icp;
  double bend = 0.0;           // the hull's bend from this fit and from what was known before, m
  PlaneCovariance covariance;  // about icp.centre, in the map's axes
};

/// How well a pose explains a cloud. A point at distance r from its nearest plane counts k^2 / (k^2 + r^2),
/// with k = PointToPlaneIcp::kScoreKernel: 1 on the plane, a half at k. A point without a plane counts 0.
struct PlaneScore {
  double sum = 0.0;          // sum over the points
  std::uint32_t points = 0;  // all points of the cloud
};

class PointToPlaneIcp {
 public:
  /// A point farther than this from a plane's centre, across the normal, does not belong to the plane, m:
  /// half the diagonal of a voxel, and a margin for centres that lie off the voxel's middle.
  static constexpr double kBesides = 1.1 * PlaneMap::kSpacing;
  /// Largest distance of a point from the nearest centre, in align() and score(), m.
  static constexpr double kGate = 0.5;
  static constexpr double kScoreKernel = 0.1;  // m

  PointToPlaneIcp(const PlaneIcpConfig& config, const BendShape& shape);

  /// Fine alignment, from a start that is off by up to some 0.3 m. `bend`: what is known of the hull's bend
  /// beforehand; with sigma 0 it is not changed.
  [[nodiscard]] PlaneIcpResult align(std::span<const Point> source, const PlaneMap& map, const Pose& T_init,
                                     const Bend& bend);

  /// Coarse alignment, from a start that is off by up to 0.5 m and 1 deg, to where align() can start. For few
  /// points: each round searches for all of them. Unlike in align(), pairs farther than kBesides off count,
  /// too. T_init if the outcome is not finite.
  [[nodiscard]] Pose approach(std::span<const Point> source, const PlaneMap& map, const Pose& T_init);

  [[nodiscard]] PlaneScore score(std::span<const Point> source, const PlaneMap& map, const Pose& T);

 private:
  struct Estimate {
    Pose T;       // motion since the search for pairs
    double bend;  // m
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
