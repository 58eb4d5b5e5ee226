#include "core/map/patches.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "core/filter/voxel_filter.hpp"
#include "core/map/plane_fit.hpp"

namespace hulltrack {
namespace {

constexpr float kRimReach = 1.0F;  // m: a coaming with its rest bar is not broader
constexpr float kBelowRim = 0.5F;  // m: sheer along a hatch; the deck is farther below
// A coaming's top is 0.3 m broad or more: of points 0.1 m apart one row at least has a disc of this radius.
constexpr float kRimVoxel = 0.1F;    // m
constexpr float kRimRadius = 0.12F;  // m
constexpr std::size_t kFewestRimNeighbours = 8;
constexpr double kRimFlat = 0.02;        // m RMS
constexpr double kRimNarrow = 0.04;      // m RMS across; a full disc has 0.06
constexpr double kRimOffCentre = 0.035;  // m; a half disc's centroid is 0.05 m aside
constexpr double kRimLevel = 0.95;       // cosine of 18 deg: heel, sheer, noise of so small a disc
constexpr float kRimSpacing = 0.2F;      // m between rim points

constexpr float kCorner = 2.0F;    // tangent of the angle from which on a direction to the hold is a side's
constexpr float kOffLine = 0.06F;  // m: the middle row of a strip is known to half of kRimVoxel
constexpr float kRimAside = 0.4F;  // m: as far as the edges of a rim are looked for
constexpr float kRimThickness = 0.04F;  // m: of the layer of points that are its top

constexpr float kConnected = 0.65F;      // m: neighbours in a 0.4 m subset
constexpr float kSameDirection = 0.99F;  // cosine of 8 deg
constexpr float kSamePlane = 0.05F;      // m: four sigma of two points and a normal off by a degree
// Behind a surface: 0.15 to 0.45 m, where it is the far side of a wall or a box that a range image of 0.4 m
// tolerance cannot tell from the near one.
constexpr float kBehindSurface = 0.3F;  // m
constexpr float kBehindRadius = 0.15F;  // m
// A patch has a square metre or a metre of rim at least: less is a fitting.
constexpr std::size_t kFewestSurfels = 6;
constexpr std::size_t kFewestRimPoints = 5;

/// Sets of points that belong together.
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

/// For each point the number of its patch, counted on from `next`; kNoPatch where it has too few. Neighbours
/// of one tile are of one patch if belong(i, j).
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
  std::vector<std::uint32_t> number(points.size(), Surfel::kNoPatch);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (sizes[i] >= fewest && unions.root(i) == i) {
      number[i] = next++;
    }
  }
  std::vector<std::uint32_t> patches(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    patches[i] = number[unions.root(i)];
  }
  return patches;
}

/// The rim's surface at p, or not: level, flat, and all around p.
bool is_on_rim(const Point& p, const Cloud& neighbours, RimPoint& rim) {
  if (neighbours.size() < kFewestRimNeighbours) {
    return false;
  }
  const PlaneFit fit = fit_plane(p, neighbours);
  if (fit.spread[0] > kRimFlat || fit.spread[1] < kRimNarrow || fit.centroid.norm() > kRimOffCentre ||
      std::abs(fit.normal.z()) < kRimLevel) {
    return false;
  }
  rim.p_H = p + fit.centroid.cast<float>();
  return true;
}

struct Line {
  Point centre, across;
};

/// The line through level points and the level direction square to it, towards `side`.
Line fit_line(const std::vector<RimPoint*>& strip, const Point& side) {
  Line line{Point::Zero(), Point::Zero()};
  for (const RimPoint* rim : strip) {
    line.centre += rim->p_H / static_cast<float>(strip.size());
  }
  Eigen::Matrix2f squares = Eigen::Matrix2f::Zero();
  for (const RimPoint* rim : strip) {
    const Eigen::Vector2f d = (rim->p_H - line.centre).head<2>();
    squares += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> solver(squares);
  const Point across(solver.eigenvectors()(0, 0), solver.eigenvectors()(1, 0), 0.0F);
  line.across = across.dot(side) < 0.0F ? Point(-across) : across;
  return line;
}

/// Moves the points of a strip onto the line through them and turns across_H square to it. What is off the
/// line, on a locker beside the coaming say, leaves the strip.
void straighten(std::vector<RimPoint*>& strip) {
  const Point side = strip.front()->across_H;
  for (const float farthest : {0.3F, 0.1F, kOffLine}) {
    const Line line = fit_line(strip, side);
    std::erase_if(strip, [&](RimPoint* rim) {
      const bool off = std::abs(line.across.dot(rim->p_H - line.centre)) > farthest;
      rim->patch = off ? Surfel::kNoPatch : rim->patch;
      return off;
    });
    if (strip.size() < kFewestRimPoints) {
      for (RimPoint* rim : strip) {
        rim->patch = Surfel::kNoPatch;
      }
      strip.clear();
      return;
    }
  }
  const Line line = fit_line(strip, side);
  for (RimPoint* rim : strip) {
    rim->across_H = line.across;
    rim->p_H -= line.across.dot(rim->p_H - line.centre) * line.across;
  }
}

/// Where the map's surface of that height ends to either side, seen over the whole strip.
void measure_strip(const KdTree& map, std::vector<RimPoint*>& strip) {
  constexpr float kBin = 0.0125F;  // m
  constexpr int kBins = static_cast<int>(2.0F * kRimAside / kBin);
  std::array<float, kBins> profile{};
  Cloud neighbours;
  for (const RimPoint* rim : strip) {
    map.within(rim->p_H, 1.2F * kRimAside, neighbours);
    for (const Point& neighbour : neighbours) {
      const Point d = neighbour - rim->p_H;
      const float s = rim->across_H.dot(d);
      const float along = Point::UnitZ().cross(rim->across_H).dot(d);
      const int bin = static_cast<int>(std::floor((s + kRimAside) / kBin));
      if (std::abs(d.z()) < kRimThickness && std::abs(along) < 0.5F * kRimSpacing && bin >= 0 &&
          bin < kBins) {
        profile[static_cast<std::size_t>(bin)] += 1.0F;
      }
    }
  }
  // Smoothed over three bins, then outward from the middle to where less than half of the middle's is left.
  const auto smooth = [&](int i) {
    const auto at = [&](int k) { return profile[static_cast<std::size_t>(std::clamp(k, 0, kBins - 1))]; };
    return (at(i - 1) + at(i) + at(i + 1)) / 3.0F;
  };
  constexpr int kEdge = 4;              // bins: 5 cm, the map's voxel
  constexpr float kMostBeyond = 0.15F;  // of the plateau
  float plateau = 0.0F;
  constexpr int kMiddle = kBins / 2;
  constexpr int kHalfWidth = 8;  // bins: 0.1 m to either side is strip
  for (int i = kMiddle - kHalfWidth; i < kMiddle + kHalfWidth; ++i) {
    plateau += profile[static_cast<std::size_t>(i)] / (2.0F * kHalfWidth);
  }
  int low = kMiddle;
  int high = kMiddle;
  while (low > 0 && smooth(low) > 0.5F * plateau) --low;
  while (high < kBins - 1 && smooth(high) > 0.5F * plateau) ++high;
  const bool sharp =
      smooth(low - kEdge) < kMostBeyond * plateau && smooth(high + kEdge) < kMostBeyond * plateau;
  if (low == 0 || high == kBins - 1 || !sharp) {
    return;  // broader than a rim, or something joins it
  }
  for (RimPoint* rim : strip) {
    rim->begin = (static_cast<float>(low) + 1.0F) * kBin - kRimAside;
    rim->end = static_cast<float>(high) * kBin - kRimAside;
  }
}

/// The side of a patch is the one that most of its surfels say, if half of them say any.
void give_patches_one_side(std::vector<Surfel>& surfels, std::uint32_t patches) {
  struct Vote {
    Point direction = Point::Zero();
    float side = 0.0F;  // for the direction, less those against it
    float surfels = 0.0F;
  };
  std::vector<Vote> votes(patches);
  for (const Surfel& surfel : surfels) {
    if (surfel.patch != Surfel::kNoPatch) {
      Vote& vote = votes[surfel.patch];
      vote.direction = vote.direction.isZero() ? surfel.normal_H : vote.direction;
      vote.surfels += 1.0F;
      vote.side += surfel.backed ? std::copysign(1.0F, vote.direction.dot(surfel.normal_H)) : 0.0F;
    }
  }
  for (Surfel& surfel : surfels) {
    if (surfel.patch != Surfel::kNoPatch) {
      const Vote& vote = votes[surfel.patch];
      const float sign =
          std::copysign(1.0F, vote.direction.dot(surfel.normal_H)) * (vote.side < 0.0F ? -1.0F : 1.0F);
      surfel.normal_H *= sign;
      surfel.backed = std::abs(vote.side) > 0.5F * vote.surfels;
    }
  }
}

}  // namespace

void orient_surfels(const Cloud& points_H, const KdTree& map, std::vector<Surfel>& surfels) {
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
}

std::vector<RimPoint> find_rims(const Cloud& cloud_H, const KdTree& map, const Relief& relief) {
  Cloud thin;
  VoxelFilter(kRimVoxel).filter(cloud_H, thin);
  std::vector<RimPoint> fine;
  Cloud fine_points;
  Cloud neighbours;
  for (const Point& p : thin) {
    const std::optional<Point> over_hold = relief.over_pit_near(p, kRimReach);
    if (!over_hold || relief.in_covers_place(p) || p.z() < relief.rim_around(*over_hold) - kBelowRim) {
      continue;
    }
    map.within(p, kRimRadius, neighbours);
    RimPoint rim;
    const Point to_hold = *over_hold - p;
    const bool along_x = std::abs(to_hold.x()) > kCorner * std::abs(to_hold.y());
    const bool along_y = std::abs(to_hold.y()) > kCorner * std::abs(to_hold.x());
    if ((along_x || along_y) && is_on_rim(p, neighbours, rim)) {
      rim.over_hold_H = *over_hold;
      rim.across_H = along_x ? Point(std::copysign(1.0F, to_hold.x()), 0.0F, 0.0F)
                             : Point(0.0F, std::copysign(1.0F, to_hold.y()), 0.0F);
      fine.push_back(rim);
      fine_points.push_back(rim.p_H);
    }
  }
  std::vector<RimPoint> rims;
  VoxelFilter spacing(kRimSpacing);
  for (const std::uint32_t i : spacing.select(fine_points)) {
    rims.push_back(fine[i]);
  }
  return rims;
}

std::uint32_t number_patches(const Cloud& points_H, std::vector<Surfel>& surfels, std::vector<RimPoint>& rims,
                             const Relief& relief) {
  std::uint32_t patches = 0;
  Cloud points;
  Cloud normals;
  std::vector<std::uint32_t> of;
  for (std::uint32_t i = 0; i < points_H.size(); ++i) {
    Surfel& surfel = surfels[i];
    surfel.movable = relief.in_covers_place(points_H[i]) || relief.in_pit(points_H[i]);
    if (surfel.planar && !surfel.movable) {
      points.push_back(points_H[i]);
      normals.push_back(surfel.normal_H);
      of.push_back(i);
    }
  }
  const std::vector<std::uint32_t> flat =
      cluster(points, kFewestSurfels, patches, [&](std::uint32_t i, std::uint32_t j) {
        const Point d = points[j] - points[i];
        return std::abs(normals[i].dot(normals[j])) > kSameDirection &&
               std::abs(normals[i].dot(d)) < kSamePlane && std::abs(normals[j].dot(d)) < kSamePlane;
      });
  for (std::size_t i = 0; i < of.size(); ++i) {
    surfels[of[i]].patch = flat[i];
  }
  give_patches_one_side(surfels, patches);
  points.clear();
  for (const RimPoint& rim : rims) {
    points.push_back(rim.p_H);
  }
  const std::vector<std::uint32_t> narrow =
      cluster(points, kFewestRimPoints, patches, [&](std::uint32_t i, std::uint32_t j) {
        return rims[i].across_H.dot(rims[j].across_H) > kSameDirection &&
               std::abs(points[j].z() - points[i].z()) < kSamePlane;
      });
  for (std::size_t i = 0; i < rims.size(); ++i) {
    rims[i].patch = narrow[i];
  }
  return patches;
}

void measure_rims(const KdTree& map, std::vector<RimPoint>& rims) {
  std::map<std::uint32_t, std::vector<RimPoint*>> strips;
  for (RimPoint& rim : rims) {
    if (rim.patch != Surfel::kNoPatch) {
      strips[rim.patch].push_back(&rim);
    }
  }
  for (auto& [patch, strip] : strips) {
    straighten(strip);
    if (!strip.empty()) {
      measure_strip(map, strip);
    }
  }
}

}  // namespace hulltrack
