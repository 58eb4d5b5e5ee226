#include "core/map/coaming.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "core/filter/voxel_filter.hpp"
#include "core/map/plane_fit.hpp"

namespace hulltrack {
namespace {

constexpr float kBelowRim = 0.5F;  // m below the relief's rim: room for sheer; the deck is farther below
// A coaming's top is 0.3 m broad or more: of points 0.1 m apart, one row has only top within this radius.
constexpr float kRimVoxel = 0.1F;    // m
constexpr float kRimRadius = 0.12F;  // m
constexpr std::size_t kFewestRimNeighbours = 8;
constexpr double kRimFlat = 0.02;        // m: largest RMS distance from the plane
constexpr double kRimNarrow = 0.04;      // m: smallest RMS extent in the plane; a full disc has 0.06
constexpr double kRimOffCentre = 0.035;  // m: largest distance of the centroid; beside an edge it is 0.05
constexpr double kRimLevel = 0.95;       // cosine of 18 deg: heel, sheer, noise of so small a disc
constexpr float kRimSpacing = 0.2F;      // m between rim points

// A point is of a side, not of a corner, if the way to the hold is this much longer along one axis.
constexpr float kCorner = 2.0F;
constexpr float kOffLine = 0.06F;       // m off the middle line: its points are known to half of kRimVoxel
constexpr float kRimAside = 0.4F;       // m from the middle line: the edges are looked for up to here
constexpr float kAtEdge = 0.08F;        // m, wall to edge: an edge is known to half of the map's 5 cm
constexpr float kSquare = 0.99F;        // cosine of 8 deg: a wall's normal against across_H
constexpr float kRimThickness = 0.04F;  // m: points of the top are this near to the rim point's height

/// Whether the neighbours of p are level, flat and all around p. If so, rim.p_H becomes their mean.
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

/// Mean of the points, and the level direction in which they spread least, turned towards `side`.
Line fit_line(const std::vector<RimPoint*>& rim, const Point& side) {
  Line line{Point::Zero(), Point::Zero()};
  for (const RimPoint* point : rim) {
    line.centre += point->p_H / static_cast<float>(rim.size());
  }
  Eigen::Matrix2f squares = Eigen::Matrix2f::Zero();
  for (const RimPoint* point : rim) {
    const Eigen::Vector2f d = (point->p_H - line.centre).head<2>();
    squares += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> solver(squares);
  const Point across(solver.eigenvectors()(0, 0), solver.eigenvectors()(1, 0), 0.0F);
  line.across = across.dot(side) < 0.0F ? Point(-across) : across;
  return line;
}

/// Fits a line, drops points off it (say on a locker beside the coaming) in three ever narrower rounds, moves
/// the rest onto it and turns across_H square to it. With too few points left the rim is given up.
void straighten(std::vector<RimPoint*>& rim) {
  const Point side = rim.front()->across_H;
  // The first round takes out what stands beside the coaming, the second what turned the line until then.
  for (const float farthest : {0.3F, 0.1F, kOffLine}) {
    const Line line = fit_line(rim, side);
    std::erase_if(rim, [&](RimPoint* point) {
      const bool off = std::abs(line.across.dot(point->p_H - line.centre)) > farthest;
      point->landmark = off ? Surfel::kNoLandmark : point->landmark;
      return off;
    });
    if (rim.size() < kFewestRimPoints) {
      for (RimPoint* point : rim) {
        point->landmark = Surfel::kNoLandmark;
      }
      rim.clear();
      return;
    }
  }
  const Line line = fit_line(rim, side);
  for (RimPoint* point : rim) {
    point->across_H = line.across;
    point->p_H -= line.across.dot(point->p_H - line.centre) * line.across;
  }
}

Point seen_from_above(const Point& p) { return {p.x(), p.y(), 0.0F}; }

/// If the surfel is a wall under an edge of the rim (below it, facing across it, within kAtEdge of the edge):
/// the level unit vector from the rim's middle through this wall. Zero otherwise.
Point outward_under(const RimPoint& rim, const Surfel& wall) {
  const Point d = wall.centre_H - rim.p_H;
  const float s = rim.across_H.dot(d);
  if (d.z() > 0.0F || std::abs(rim.across_H.dot(wall.normal_H)) < kSquare) {
    return Point::Zero();
  }
  if (std::abs(s - rim.end) < kAtEdge) {
    return rim.across_H;
  }
  return std::abs(s - rim.begin) < kAtEdge ? Point(-rim.across_H) : Point::Zero();
}

/// Finds the rim's edges: counts map points of the rim's height over the distance from its middle line.
void measure_rim(const KdTree& map, std::vector<RimPoint*>& rim) {
  constexpr float kBin = 0.0125F;  // m
  constexpr int kBins = static_cast<int>(2.0F * kRimAside / kBin);
  std::array<float, kBins> profile{};
  Cloud neighbours;
  for (const RimPoint* point : rim) {
    map.within(point->p_H, std::hypot(kRimAside, 0.5F * kRimSpacing, kRimThickness), neighbours);
    for (const Point& neighbour : neighbours) {
      const Point d = neighbour - point->p_H;
      const float s = point->across_H.dot(d);
      const float along = Point::UnitZ().cross(point->across_H).dot(d);
      const int bin = static_cast<int>(std::floor((s + kRimAside) / kBin));
      if (std::abs(d.z()) < kRimThickness && std::abs(along) < 0.5F * kRimSpacing && bin >= 0 &&
          bin < kBins) {
        profile[static_cast<std::size_t>(bin)] += 1.0F;
      }
    }
  }
  // An edge is where the count, smoothed over three bins, falls to half of the mean count in the middle.
  const auto smooth = [&](int i) {
    const auto at = [&](int k) { return profile[static_cast<std::size_t>(std::clamp(k, 0, kBins - 1))]; };
    return (at(i - 1) + at(i) + at(i + 1)) / 3.0F;
  };
  constexpr int kEdge = 4;              // bins: 5 cm, the map's voxel. So far beyond an edge ...
  constexpr float kMostBeyond = 0.15F;  // ... at most this share of the middle's count may be left
  float plateau = 0.0F;
  constexpr int kMiddle = kBins / 2;
  constexpr int kHalfWidth = 8;  // bins: 0.1 m to either side is rim
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
    return;  // broader than a rim, or another surface joins it: the edges stay unknown
  }
  for (RimPoint* point : rim) {
    point->begin = (static_cast<float>(low) + 1.0F) * kBin - kRimAside;
    point->end = static_cast<float>(high) * kBin - kRimAside;
  }
}

}  // namespace

std::vector<RimPoint> find_rims(const Cloud& cloud_H, const KdTree& map, const Relief& relief) {
  Cloud thin;
  VoxelFilter(kRimVoxel).filter(cloud_H, thin);
  std::vector<RimPoint> fine;
  Cloud fine_points;
  Cloud neighbours;
  for (const Point& p : thin) {
    const std::optional<Point> over_hold = relief.over_hold_near(p, kRimReach);
    if (!over_hold || relief.in_covers_place(p) || p.z() < relief.rim_height_around(*over_hold) - kBelowRim) {
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

std::vector<RimPoint> measured_rims(const KdTree& map, std::vector<RimPoint> rims) {
  std::map<std::uint32_t, std::vector<RimPoint*>> by_landmark;
  for (RimPoint& rim : rims) {
    if (rim.landmark != Surfel::kNoLandmark) {
      by_landmark[rim.landmark].push_back(&rim);
    }
  }
  for (auto& [landmark, rim] : by_landmark) {
    straighten(rim);
    if (!rim.empty()) {
      measure_rim(map, rim);
    }
  }
  return rims;
}

std::vector<Point> find_coaming_walls(std::span<const RimPoint> rims, std::uint32_t landmarks,
                                      std::span<const Surfel> surfels) {
  std::vector<RimPoint> measured;
  std::copy_if(rims.begin(), rims.end(), std::back_inserter(measured),
               [](const RimPoint& rim) { return rim.is_measured(); });
  std::vector<Point> outward(landmarks, Point::Zero());
  if (measured.empty()) {
    return outward;
  }
  Cloud places;
  for (const RimPoint& rim : measured) {
    places.push_back(seen_from_above(rim.p_H));
  }
  const KdTree tree(places);
  std::vector<float> members(landmarks, 0.0F);
  for (const Surfel& surfel : surfels) {
    if (surfel.landmark != Surfel::kNoLandmark) {
      ++members[surfel.landmark];
      if (const auto near = tree.nearest(seen_from_above(surfel.centre_H), kRimAside)) {
        outward[surfel.landmark] += outward_under(measured[near->index], surfel);
      }
    }
  }
  for (std::size_t i = 0; i < outward.size(); ++i) {
    if (!(outward[i].norm() > 0.5F * members[i])) {
      outward[i].setZero();
    }
  }
  return outward;
}

}  // namespace hulltrack
