// The flat parts of a hull map as small planes, for point to plane registration.
//
// One plane in each voxel of kSpacing where the map is flat (surfels.hpp). Edges, rails and wires get no
// plane, since a point near them says nothing about one. Floors of holds and places where hatch covers may
// stand (relief.hpp) get none either: cargo and covers change from day to day. A plane is fitted to about a
// hundred map points, so that its noise is a tenth of a point's.
// Frame H, metres. Immutable.
// Cost: 2 us a plane to build, some 100,000 planes for a ship of 120 m; 45 bytes a plane.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/kdtree/kdtree.hpp"
#include "core/map/relief.hpp"
#include "core/map/surfel.hpp"

namespace hulltrack {

class PlaneMap {
 public:
  static constexpr float kSpacing = 0.2F;  // m

  struct Plane {
    Point centre_H;
    Point normal_H;  // unit, sign arbitrary
    SurfaceClass surface;
    std::uint32_t cluster;  // number of its cluster (see kClusterSize), below clusters()
  };
  /// A cluster is all planes of one class in a cube of this size, connected or not. Errors of the map and of
  /// what lies on a surface are shared over about this length; a few dozen clusters are in view. The
  /// covariance of a fit needs them (see core/registration/plane_covariance.hpp).
  static constexpr float kClusterSize = 3.0F;  // m

  /// `map` is the tree over `cloud_H`.
  PlaneMap(const Cloud& cloud_H, const KdTree& map, const Relief& relief);

  [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }
  [[nodiscard]] std::uint32_t clusters() const { return clusters_; }
  /// Search tree over the planes' centres; its indices are those of planes().
  [[nodiscard]] const KdTree& tree() const { return tree_; }

 private:
  std::vector<Plane> planes_;
  std::uint32_t clusters_ = 0;
  KdTree tree_;
};

}  // namespace hulltrack
