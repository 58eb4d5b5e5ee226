#include "core/quay/quay_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <span>

#include "core/filter/voxel_filter.hpp"
#include "core/geometry/box.hpp"
#include "core/kdtree/kdtree.hpp"
#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

using TileKey = std::array<int, 3>;  // class, column, row

// A point of the cloud that is farther than this off a plane, along its normal, is of something else, m: the
// other side of a thin wall or of a leg, a step, the foot of a wall. A scan could take it for the plane. It
// is three times a flat surface's noise.
constexpr float kAnother = 0.12F;

/// Whether nothing else lies before or behind the surfel within kAlone. `around`: scratch.
bool is_alone(const Surfel& surfel, const KdTree& tree, Cloud& around) {
  tree.within(surfel.centre_H, QuayMap::kAlone, around);
  return std::none_of(around.begin(), around.end(), [&](const Point& p) {
    const Point d = p - surfel.centre_H;
    const float off = surfel.normal_H.dot(d);
    return std::abs(off) > kAnother && d.squaredNorm() - off * off < QuayMap::kBesides * QuayMap::kBesides;
  });
}

std::vector<QuayMap::Plane> find_planes(const Cloud& cloud_W) {
  const KdTree tree(cloud_W);
  Cloud points_W;
  VoxelFilter(QuayMap::kSpacing).filter(cloud_W, points_W);
  Cloud around;
  std::vector<QuayMap::Plane> planes;
  for (const Surfel& surfel : compute_surfels(points_W, tree)) {
    if (surfel.planar && is_alone(surfel, tree, around)) {
      planes.push_back({surfel.centre_H, surfel.normal_H, surfel.surface});
    }
  }
  return planes;
}

TileKey key_of(const QuayMap::Plane& plane) {
  const auto tile = [](float v) { return static_cast<int>(std::floor(v / QuayMap::kTile)); };
  return {static_cast<int>(plane.surface), tile(plane.centre_W.x()), tile(plane.centre_W.y())};
}

/// The planes sorted by tile, shuffled within each.
std::vector<QuayMap::Plane> tile_by_tile(std::vector<QuayMap::Plane> planes) {
  std::shuffle(planes.begin(), planes.end(), std::mt19937(1));  // fixed seed: the same map, the same order
  std::stable_sort(planes.begin(), planes.end(),
                   [](const QuayMap::Plane& a, const QuayMap::Plane& b) { return key_of(a) < key_of(b); });
  return planes;
}

QuayMap::Tile tile_around(std::span<const QuayMap::Plane> planes, std::size_t first) {
  Box box = Box::none();
  for (const QuayMap::Plane& plane : planes) {
    box.add(plane.centre_W);
  }
  return {(box.min + box.max) / 2.0F, box.diagonal() / 2.0F, static_cast<std::uint32_t>(first),
          static_cast<std::uint32_t>(planes.size())};
}

std::array<std::vector<QuayMap::Tile>, QuayMap::kClasses> tiles_of(
    const std::vector<QuayMap::Plane>& planes) {
  std::array<std::vector<QuayMap::Tile>, QuayMap::kClasses> tiles;
  for (std::size_t first = 0, end = 0; first < planes.size(); first = end) {
    const TileKey key = key_of(planes[first]);
    for (end = first; end < planes.size() && key_of(planes[end]) == key; ++end) {
    }
    tiles.at(static_cast<std::size_t>(key[0]))
        .push_back(tile_around(std::span(planes).subspan(first, end - first), first));
  }
  return tiles;
}

Cloud centres_of(const std::vector<QuayMap::Plane>& planes) {
  Cloud centres_W;
  centres_W.reserve(planes.size());
  for (const QuayMap::Plane& plane : planes) {
    centres_W.push_back(plane.centre_W);
  }
  return centres_W;
}

}  // namespace

QuayMap::QuayMap(const Cloud& cloud_W)
    : planes_(tile_by_tile(find_planes(cloud_W))),
      tiles_(tiles_of(planes_)),
      tree_(centres_of(planes_)),
      things_(cloud_W) {
  for (const Plane& plane : planes_) {
    cells_.add(plane.centre_W, plane.normal_W, kGate, kBesides, plane.surface);
  }
}

std::size_t QuayMap::count(SurfaceClass surface) const {
  const std::vector<Tile>& tiles = tiles_[static_cast<std::size_t>(surface)];
  return std::accumulate(tiles.begin(), tiles.end(), std::size_t{0},
                         [](std::size_t sum, const Tile& tile) { return sum + tile.count; });
}

}  // namespace hulltrack
