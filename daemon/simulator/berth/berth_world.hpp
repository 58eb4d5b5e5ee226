// What does a ray leaving a LiDAR at time t meet? The berth with bodies that move on their own: berth in W,
// water in W at the tide's level, hull in H, portal in G, boom in B, a crane that drives past, the traffic on
// the quay - each where it is at that very moment, the hull in the shape that it has by then.
//
// Rays are given in L. Within a `Sweep` (one datagram, about a millisecond) the bodies' poses are
// interpolated between its ends, which is exact to well below a micrometre. Metres, seconds from the first
// firing. Immutable after construction: any number of threads may cast. About 1 us a ray.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "core/kinematics/loader_kinematics.hpp"
#include "daemon/simulator/berth/loader_motion.hpp"
#include "daemon/simulator/berth/quay_traffic.hpp"
#include "daemon/simulator/sensing/ray_scene.hpp"
#include "daemon/simulator/ship/hull_motion.hpp"
#include "daemon/simulator/ship/hull_shape.hpp"

namespace hulltrack {

/// A crane drives along the quay: from x = `from` on, forward in W.
struct Passage {
  double from = 0.0;  // m
  Run run;
};

class BerthWorld {
 public:
  /// L seen from each body at the beginning and the end of a short span of time.
  struct Sweep {
    static constexpr std::size_t kBodies = 6 + kMovers;
    double begin, end;  // s
    std::array<Eigen::Matrix<float, 3, 4>, kBodies> at_begin, at_end;
  };

  /// `hull_meshes_H`: one for each of the shapes of `change`, in the ship's place of when the map was made.
  /// `seed`: of the traffic on the quay. Motions and change must outlive the world.
  BerthWorld(const std::vector<TriangleMesh>& hull_meshes_H, const ShapeChange& change,
             const LoaderMotion& loader, const HullMotion& hull, const std::optional<Passage>& crane,
             std::uint64_t seed);

  /// Of a LiDAR with T_lidar = `mount`.
  [[nodiscard]] Sweep sweep(const Pose& mount, double begin, double end) const;

  /// First surface of any body along a ray in L at time t within the sweep.
  [[nodiscard]] std::optional<RayHit> cast(const Sweep& sweep, double t, const Point& origin_L,
                                           const Point& direction_L, float max_range) const;

  /// A ray's origin and direction in W, at time t within the sweep.
  [[nodiscard]] static std::pair<Point, Point> ray_W(const Sweep& sweep, double t, const Point& origin_L,
                                                     const Point& direction_L);

 private:
  using Affine = Eigen::Matrix<float, 3, 4>;
  using Placement = std::array<Affine, Sweep::kBodies>;
  enum Body : std::size_t { kBoom, kHull, kBerth, kPortal, kWater, kCrane, kFirstMover };

  [[nodiscard]] static Affine between(const Sweep& sweep, double t, std::size_t body);
  [[nodiscard]] Placement placement(const Pose& mount, double t) const;
  [[nodiscard]] const RayScene* scene(std::size_t body, std::size_t shape) const;
  /// Is there no water at a point of the river's level because the hull is below it (inside a hold)?
  [[nodiscard]] bool displaced(const Sweep& sweep, double t, std::size_t shape, const Point& p_L) const;

  RayScene boom_, berth_, portal_, water_;
  std::vector<RayScene> hulls_;  // one a shape
  std::optional<RayScene> crane_;
  std::vector<RayScene> movers_;
  std::vector<Walk> walks_;
  Passage passage_;
  const ShapeChange* change_;
  const LoaderMotion* loader_;
  const HullMotion* hull_;
};

}  // namespace hulltrack
