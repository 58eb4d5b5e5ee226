// The flat parts of a hull map as small planes, for point to plane registration.
//
// One plane a voxel of kSpacing wherever the map is flat around it (surfels.hpp); edges, rails and wires have
// none, since a point near them says nothing about a plane. Nor have the floors of holds, which cargo covers,
// and hatch covers, which move (relief.hpp). Each plane is the fit to about a hundred map
// points, so that it is a tenth as noisy as one of them. Frame H, metres. Immutable.
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
    std::uint32_t patch;  // number of the piece of surface that it belongs to, below patches()
  };
  /// A patch is what lies in one cube of this size and faces one way: as far as errors of the map and of what
  /// lies on a surface are shared, and a few dozen of them are in view.
  static constexpr float kPatch = 3.0F;  // m

  /// `map` is the tree over `cloud_H`.
  PlaneMap(const Cloud& cloud_H, const KdTree& map, const Relief& relief);

  [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }
  [[nodiscard]] std::uint32_t patches() const { return patches_; }
  /// Over the centres; its indices are those of planes().
  [[nodiscard]] const KdTree& tree() const { return tree_; }

 private:
  std::vector<Plane> planes_;
  std::uint32_t patches_ = 0;
  KdTree tree_;
};

}  // namespace hulltrack
