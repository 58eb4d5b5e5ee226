// How does a sensor see points: where in its frame, how far away, in which direction?
//
// Moves points of any frame into the sensor's frame L; gives their squared range and their cell of
// SphericalGrid, the same as SphericalGrid::cell(). Works on a block of 64 points at a time, so that the
// processor handles several at once. Metres, float. Pure; a point that is not finite gets some cell and a
// range that is not finite.
// Cost: some 5 ns a point.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack {

/// A block of points as structure of arrays.
struct Sightings {
  static constexpr std::size_t kBlock = 64;

  float x[kBlock], y[kBlock], z[kBlock];  // in L, m
  float range2[kBlock];                   // squared distance from L's origin, m^2
  std::uint32_t cell[kBlock];             // SphericalGrid::Cell::index()

  [[nodiscard]] Point point(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Sees `points` of a frame A from L. At most Sightings::kBlock points; entries of `out` beyond their number
/// are undefined.
void sight_block(std::span<const Point> points, const Eigen::Matrix3f& R_L_A, const Point& t_L_A,
                 Sightings& out);

/// Calls visit(index of the point, sightings, index therein) for all points, in order.
template <typename Visit>
void sight(std::span<const Point> points, const Pose& T_L_A, Visit&& visit) {
  const Eigen::Matrix3f R = T_L_A.linear().cast<float>();
  const Point t = T_L_A.translation().cast<float>();
  Sightings block;
  for (std::size_t first = 0; first < points.size(); first += Sightings::kBlock) {
    const std::size_t count = std::min(Sightings::kBlock, points.size() - first);
    sight_block(points.subspan(first, count), R, t, block);
    for (std::size_t i = 0; i < count; ++i) {
      visit(first + i, block, i);
    }
  }
}

}  // namespace hulltrack
