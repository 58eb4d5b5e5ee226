// What does a ray from the LiDAR meet at time t? Four rigid bodies: the berth in W, the hull in H, the
// portal in G, the boom in B, each where it is at that very moment.
//
// Rays are given in L. Within a `Sweep` (one datagram, about a millisecond) the bodies' poses are
// interpolated between its ends, which is exact to well below a micrometre. Metres, seconds from the first
// firing. Immutable after construction: any number of threads may cast. About 1 us a ray.
#pragma once

#include <array>
#include <optional>

#include "core/kinematics/loader_kinematics.hpp"
#include "daemon/simulator/hull_motion.hpp"
#include "daemon/simulator/loader_motion.hpp"
#include "daemon/simulator/ray_scene.hpp"

namespace hulltrack {

class BerthWorld {
 public:
  /// L seen from each body at the beginning and the end of a short span of time.
  struct Sweep {
    static constexpr std::size_t kBodies = 4;
    double begin, end;  // s
    std::array<Eigen::Matrix<float, 3, 4>, kBodies> at_begin, at_end;
  };

  /// `hull_mesh_H` is the ship as it lay when the map was made. Motions must outlive the world.
  BerthWorld(TriangleMesh hull_mesh_H, const LoaderMotion& loader, const HullMotion& hull, const Pose& mount);

  [[nodiscard]] Sweep sweep(double begin, double end) const;

  /// First surface of any body along a ray in L at time t within the sweep.
  [[nodiscard]] std::optional<RayHit> cast(const Sweep& sweep, double t, const Point& origin_L,
                                           const Point& direction_L, float max_range) const;

  /// T_W_L at time t by the true joints.
  [[nodiscard]] Pose T_W_L(double t) const;

 private:
  using Placement = std::array<Eigen::Matrix<float, 3, 4>, Sweep::kBodies>;
  [[nodiscard]] Placement placement(double t) const;
  /// Is there no water at a point of the river's level because the hull is below it (inside a hold)?
  [[nodiscard]] bool displaced(const Sweep& sweep, float s, const Point& p_L) const;

  static constexpr std::size_t kHull = 1;  // boom, hull, berth, portal

  std::array<RayScene, Sweep::kBodies> bodies_;
  const LoaderMotion* loader_;
  const HullMotion* hull_;
  Pose mount_;
};

}  // namespace hulltrack
