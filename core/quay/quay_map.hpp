// The map of what stands still around a berth, made of a cloud without a ship. It has two parts.
//
// - Planes: one for each voxel of kSpacing where the cloud is flat (surfels.hpp) and has nothing else close
//   before or behind it. Wires, bollards, edges, thin walls seen from both sides and feet of walls have none.
// - Things: every place where the cloud has any point (near_cells.hpp).
// Frame W, metres. Immutable; any number of threads may ask. Precondition of the constructor: finite points
// (core/io checks files). No failure: a cloud without flat parts has no planes. Cost: 5 us a plane to build;
// 60 to 350 bytes a plane.
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
  /// A point is not of a plane if it is farther than this from the plane's middle, across its normal, m. It
  /// is half of a voxel's diagonal, and a margin for middles that are off their voxel's.
  static constexpr float kBesides = 1.1F * kSpacing;
  /// A plane is kept only if the cloud has nothing else before or behind it within this distance of its
  /// middle, m. What a scan finds there is then the plane.
  static constexpr float kAlone = 0.75F;
  /// A return that is farther off a plane than this is of something else, m.
  static constexpr float kGate = 0.6F;
  /// Edge of the level squares (tiles) in which planes are kept, m. Tiles far from a sensor are passed over.
  static constexpr float kTile = 8.0F;

  struct Plane {
    Point centre_W;
    Point normal_W;  // unit, sign arbitrary
    SurfaceClass surface;

    /// How far p is off the plane along its normal, m.
    [[nodiscard]] double offset(const Point& p_W) const {
      return static_cast<double>(normal_W.dot(p_W - centre_W));
    }
    /// Whether p is off the plane by no more than `gate` (m), and within kBesides of its middle.
    [[nodiscard]] bool holds(const Point& p_W, double gate) const {
      const double off = offset(p_W);
      return std::abs(off) <= gate &&
             static_cast<double>((p_W - centre_W).squaredNorm()) - off * off <= double{kBesides} * kBesides;
    }
  };
  /// The planes of one class in one tile, shuffled: every n-th of them is an even sample of the tile.
  struct Tile {
    Point middle_W;              // of the planes' box
    float radius;                // of a ball around middle_W that holds their centres, m
    std::uint32_t first, count;  // they are planes()[first, first + count)
  };

  explicit QuayMap(const Cloud& cloud_W);

  [[nodiscard]] const std::vector<Plane>& planes() const { return planes_; }
  /// Search tree of the planes' centres; its indices are those of planes().
  [[nodiscard]] const KdTree& tree() const { return tree_; }
  /// The three classes of SurfaceClass, and `other` as the last.
  static constexpr std::size_t kClasses = kSurfaceClasses + 1;
  [[nodiscard]] const std::vector<Tile>& tiles(std::size_t surface) const { return tiles_[surface]; }
  [[nodiscard]] std::size_t count(SurfaceClass surface) const;
  /// Whether anything of the map is near a place, flat or not.
  [[nodiscard]] const NearCells& things() const { return things_; }
  /// A bit for every class with a plane that holds p within kGate. There may be bits too many, never too few.
  [[nodiscard]] SurfaceCells::Classes classes_near(const Point& p_W) const { return cells_.at(p_W); }

 private:
  std::vector<Plane> planes_;  // tile by tile
  std::array<std::vector<Tile>, kClasses> tiles_;
  KdTree tree_;
  SurfaceCells cells_;
  NearCells things_;
};

}  // namespace hulltrack
