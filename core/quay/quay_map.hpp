// What stands still in W: as small planes that a scan is asked for, and as places where there is anything.
//
// The surroundings of a berth without a ship. One plane a voxel of kSpacing wherever the cloud is flat around
// it (surfels.hpp) and has nothing else close before or behind it; wires, bollards, edges, thin walls that
// were seen from both sides and the feet of walls have none. Frame W, metres. Immutable. Precondition of the
// constructor: finite points (core/io checks files). No failure: a cloud without flat parts has no planes.
// Cost: 5 us a plane to build; 60 to 350 bytes a plane.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/kdtree/kdtree.hpp"
#include "core/map/surfel.hpp"
#include "core/quay/near_cells.hpp"
#include "core/quay/surface_cells.hpp"

namespace hulltrack {

class QuayMap {
 public:
  static constexpr float kSpacing = 0.4F;  // m
  /// Farther than this from a plane's middle, across its normal, a point is not of it, m: half the diagonal
  /// of a voxel and a margin for middles that lie off.
  static constexpr float kBesides = 1.1F * kSpacing;
  /// Nothing else is as near as this to a plane's middle, before or behind it: what a scan finds there is the
  /// plane. m
  static constexpr float kAlone = 0.75F;
  /// m: what lies farther off a plane belongs to something else.
  static constexpr float kGate = 0.6F;
  /// Planes are kept in tiles of this size, level, so that those far from a sensor are passed over. m
  static constexpr float kTile = 8.0F;

  struct Plane {
    Point centre_W;
    Point normal_W;  // unit, sign arbitrary
    SurfaceClass surface;

    /// How far p is off the plane along its normal, m.
    [[nodiscard]] double offset(const Point& p_W) const {
      return static_cast<double>(normal_W.dot(p_W - centre_W));
    }
    /// Whether p is off by no more than `gate` (m), and not beside the plane.
    [[nodiscard]] bool holds(const Point& p_W, double gate) const {
      const double off = offset(p_W);
      return std::abs(off) <= gate &&
             static_cast<double>((p_W - centre_W).squaredNorm()) - off * off <= double{kBesides} * kBesides;
    }
  };
  /// The planes of one class in one tile, in no order that has to do with where they are.
  struct Tile {
    Point middle_W;  // of the planes' box
    float radius;    // of a ball around it that holds them, m
    std::uint32_t first, count;
  };

  explicit QuayMap(const Cloud& cloud_W);

  [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }
  /// Over the centres; its indices are those of planes().
  [[nodiscard]] const KdTree& tree() const { return tree_; }
  /// Of the classes of SurfaceClass, `other` last.
  static constexpr std::size_t kClasses = kSurfaceClasses + 1;
  [[nodiscard]] const std::vector<Tile>& tiles(std::size_t surface) const { return tiles_[surface]; }
  [[nodiscard]] std::size_t count(SurfaceClass surface) const;
  /// Where there is anything of it, flat or not.
  [[nodiscard]] const NearCells& things() const { return things_; }
  /// Names at least every class that has a plane which holds p within kGate.
  [[nodiscard]] SurfaceCells::Classes classes_near(const Point& p_W) const { return cells_.at(p_W); }

 private:
  std::vector<Plane> planes_;  // tile by tile
  std::array<std::vector<Tile>, kClasses> tiles_;
  KdTree tree_;
  SurfaceCells cells_;
  NearCells things_;
};

}  // namespace hulltrack
