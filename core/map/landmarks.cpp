#include "core/map/landmarks.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace hulltrack {
namespace {

constexpr float kConnected = 0.65F;      // m between neighbours: the subset has a point in each 0.4 m voxel
constexpr float kSameDirection = 0.99F;  // cosine of 8 deg between the normals of neighbours
// Neighbours are this near to each other's plane, m: four sigma of two points and a normal off by a degree.
constexpr float kSamePlane = 0.05F;
// A surface has another one behind it if the map has a point within kBehindRadius of the place kBehindSurface
// behind it: the far side of a wall or a box. The range image (visibility.hpp), whose tolerance is 0.4 m,
// cannot tell it from the near side.
constexpr float kBehindSurface = 0.3F;     // m
constexpr float kBehindRadius = 0.15F;     // m
constexpr std::size_t kFewestSurfels = 6;  // of a landmark: a square metre; what is smaller is a fitting

/// Disjoint sets of points that belong together (union-find).
class Unions {
 public:
  explicit Unions(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

std::array<int, 3> tile_of(const Point& p) {
  const auto tile = [](float v) { return static_cast<int>(std::floor(v / kTile)); };
  return {tile(p.x()), tile(p.y()), tile(p.z())};
}

/// For each point the number of its landmark, numbers from `next` on; kNoLandmark if the landmark has fewer
/// than `fewest` points. Neighbours i, j within kConnected and in one tile belong to one landmark if
/// belong(i, j).
template <typename Belong>
std::vector<std::uint32_t> cluster(const Cloud& points, std::size_t fewest, std::uint32_t& next,
                                   Belong&& belong) {
  constexpr std::size_t kMostNeighbours = 32;
  const KdTree tree(points);
  Unions unions(points.size());
  std::vector<Neighbour> neighbours;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    tree.nearest_k(points[i], kMostNeighbours, kConnected, neighbours);
    for (const Neighbour& neighbour : neighbours) {
      const std::uint32_t j = neighbour.index;
      if (j > i && tile_of(points[i]) == tile_of(points[j]) && belong(i, j)) {
        unions.join(i, j);
      }
    }
  }
  std::vector<std::size_t> sizes(points.size(), 0);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    ++sizes[unions.root(i)];
  }
  std::vector<std::uint32_t> number(points.size(), Surfel::kNoLandmark);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (sizes[i] >= fewest && unions.root(i) == i) {
      number[i] = next++;
    }
  }
  std::vector<std::uint32_t> landmarks(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    landmarks[i] = number[unions.root(i)];
  }
  return landmarks;
}

/// The side of each landmark to which most of its backed surfels face, and whether that makes it backed: the
/// majority has to be larger than half of all its surfels.
struct Side {
  Point direction = Point::Zero();  // normal of the landmark's first surfel, turned to that side
  bool backed = false;
};
std::vector<Side> sides_of(std::span<const Surfel> surfels, std::uint32_t landmarks) {
  struct Vote {
    Point direction = Point::Zero();  // normal of the landmark's first surfel
    float side = 0.0F;  // backed surfels that face the direction, less those that face away from it
    float surfels = 0.0F;
  };
  std::vector<Vote> votes(landmarks);
  for (const Surfel& surfel : surfels) {
    if (surfel.landmark != Surfel::kNoLandmark) {
      Vote& vote = votes[surfel.landmark];
      vote.direction = vote.direction.isZero() ? surfel.normal_H : vote.direction;
      vote.surfels += 1.0F;
      vote.side += surfel.backed ? std::copysign(1.0F, vote.direction.dot(surfel.normal_H)) : 0.0F;
    }
  }
  std::vector<Side> sides;
  for (const Vote& vote : votes) {
    sides.push_back({vote.side < 0.0F ? Point(-vote.direction) : vote.direction,
                     std::abs(vote.side) > 0.5F * vote.surfels});
  }
  return sides;
}

/// The surfels, all of a landmark facing one side.
std::vector<Surfel> facing(std::vector<Surfel> surfels, std::span<const Side> sides) {
  for (Surfel& surfel : surfels) {
    if (surfel.landmark != Surfel::kNoLandmark) {
      const Side& side = sides[surfel.landmark];
      surfel.normal_H *= std::copysign(1.0F, side.direction.dot(surfel.normal_H));
      surfel.backed = side.backed;
    }
  }
  return surfels;
}

/// The sides that coamings' walls turn outward; the others as they are.
std::vector<Side> with_walls(std::vector<Side> sides, std::span<const Point> outward) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!outward[i].isZero(0.0F)) {
      sides[i] = {outward[i], true};
    }
  }
  return sides;
}

std::vector<Landmark> describe_landmarks(const Relief& relief, const std::vector<Surfel>& surfels,
                                         const std::vector<RimPoint>& rims, std::uint32_t landmarks,
                                         std::span<const Point> outward) {
  std::vector<Landmark> described(landmarks);
  std::vector<float> members(landmarks, 0.0F);
  const auto add = [&](std::uint32_t number, LandmarkKind kind, SurfaceClass faces, const Point& p) {
    Landmark& landmark = described[number];
    landmark.kind = kind;
    landmark.faces = faces;
    if (faces != SurfaceClass::other) {
      landmark.place += (p[static_cast<Eigen::Index>(faces)] - landmark.place) / ++members[number];
    }
    if (landmark.hold == Relief::kNoHold) {
      landmark.hold = relief.hold_near(p, kRimReach);
    }
  };
  for (const Surfel& surfel : surfels) {
    if (surfel.landmark != Surfel::kNoLandmark) {
      const LandmarkKind kind =
          outward[surfel.landmark].isZero(0.0F) ? LandmarkKind::surface : LandmarkKind::coaming_wall;
      add(surfel.landmark, kind, surfel.surface, surfel.centre_H);
    }
  }
  for (const RimPoint& rim : rims) {
    if (rim.landmark != Surfel::kNoLandmark) {
      const bool along_x = std::abs(rim.across_H.x()) > std::abs(rim.across_H.y());
      add(rim.landmark, LandmarkKind::rim, along_x ? SurfaceClass::transverse : SurfaceClass::longitudinal,
          rim.p_H);
    }
  }
  return described;
}

}  // namespace

std::vector<Surfel> oriented_surfels(const Cloud& points_H, const KdTree& map, std::vector<Surfel> surfels) {
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    Surfel& surfel = surfels[i];
    if (!surfel.planar) {
      continue;
    }
    const Point aside = kBehindSurface * surfel.normal_H;
    const bool ahead = map.nearest(points_H[i] + aside, kBehindRadius).has_value();
    const bool behind = map.nearest(points_H[i] - aside, kBehindRadius).has_value();
    surfel.backed = ahead != behind;
    surfel.normal_H *= ahead && !behind ? -1.0F : 1.0F;
  }
  return surfels;
}

LandmarkedMap find_landmarks(const Cloud& points_H, const KdTree& map, const Relief& relief,
                             std::vector<Surfel> surfels, std::vector<RimPoint> rims) {
  std::uint32_t landmarks = 0;
  Cloud points;
  Cloud normals;
  std::vector<std::uint32_t> of;
  for (std::uint32_t i = 0; i < points_H.size(); ++i) {
    Surfel& surfel = surfels[i];
    surfel.movable = relief.under_covers_place(points_H[i]) || relief.in_hold(points_H[i]);
    if (surfel.planar && !surfel.movable) {
      points.push_back(points_H[i]);
      normals.push_back(surfel.normal_H);
      of.push_back(i);
    }
  }
  const std::vector<std::uint32_t> flat =
      cluster(points, kFewestSurfels, landmarks, [&](std::uint32_t i, std::uint32_t j) {
        const Point d = points[j] - points[i];
        return std::abs(normals[i].dot(normals[j])) > kSameDirection &&
               std::abs(normals[i].dot(d)) < kSamePlane && std::abs(normals[j].dot(d)) < kSamePlane;
      });
  for (std::size_t i = 0; i < of.size(); ++i) {
    surfels[of[i]].landmark = flat[i];
  }
  points.clear();
  for (const RimPoint& rim : rims) {
    points.push_back(rim.p_H);
  }
  std::vector<Side> sides = sides_of(surfels, landmarks);
  const std::vector<std::uint32_t> narrow =
      cluster(points, kFewestRimPoints, landmarks, [&](std::uint32_t i, std::uint32_t j) {
        return rims[i].across_H.dot(rims[j].across_H) > kSameDirection &&
               std::abs(points[j].z() - points[i].z()) < kSamePlane;
      });
  for (std::size_t i = 0; i < rims.size(); ++i) {
    rims[i].landmark = narrow[i];
  }
  sides.resize(landmarks);  // rims have no surfels to turn
  rims = measured_rims(map, std::move(rims));
  const std::vector<Point> outward = find_coaming_walls(rims, landmarks, surfels);
  surfels = facing(std::move(surfels), with_walls(std::move(sides), outward));
  std::vector<Landmark> described = describe_landmarks(relief, surfels, rims, landmarks, outward);
  return {std::move(described), std::move(surfels), std::move(rims)};
}

}  // namespace hulltrack
