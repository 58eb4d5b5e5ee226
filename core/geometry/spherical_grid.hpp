// Directions from a sensor in cells of one degree: which cell does a point fall into?
//
// Rows are elevations from -90 deg, columns azimuths from -180 deg, about the z axis of the frame that the
// point is given in (L). Cells shrink towards the poles, where no spinning LiDAR looks.
// Pure; every point gets a cell, also the origin and NaN. Cost: a few ns, no table.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// An approximation of atan2 to 1e-5 rad: the polynomial of Abramowitz & Stegun 4.4.49 for angles up to 45
/// deg, and symmetry. Several times as fast as std::atan2, and without branches, so that a loop over it can
/// be vectorised. fast_atan2(0, 0) = 0.
[[nodiscard]] inline float fast_atan2(float y, float x) {
  constexpr float kHalfPi = std::numbers::pi_v<float> / 2.0F;
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float q = std::min(ax, ay) / std::max(std::max(ax, ay), std::numeric_limits<float>::min());
  const float s = q * q;
  const float octant =
      q * (0.9998660F + s * (-0.3302995F + s * (0.1801410F + s * (-0.0851330F + s * 0.0208351F))));
  const float beyond = kHalfPi - octant;
  const float quadrant = ay > ax ? beyond : octant;
  const float behind = std::numbers::pi_v<float> - quadrant;
  return std::copysign(x < 0.0F ? behind : quadrant, y);
}

struct SphericalGrid {
  static constexpr int kColumns = 360;
  static constexpr int kRows = 180;
  static constexpr std::size_t kCells = std::size_t{kColumns} * kRows;

  struct Cell {
    int row;     // 0 .. kRows - 1
    int column;  // 0 .. kColumns - 1
    [[nodiscard]] std::size_t index() const {
      return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
    }
    /// A neighbour; columns wrap around, rows stop at the poles.
    [[nodiscard]] Cell moved(int rows, int columns) const {
      return {std::clamp(row + rows, 0, kRows - 1), (column + columns + kColumns) % kColumns};
    }
  };

  /// Row of a direction that rises by `z` over a horizontal distance `planar` (>= 0).
  [[nodiscard]] static int row(float planar, float z) { return whole(fast_atan2(z, planar), 90.0F, kRows); }
  [[nodiscard]] static int column(float x, float y) { return whole(fast_atan2(y, x), 180.0F, kColumns); }
  /// Half the work of cell(), for callers that need the row first.
  [[nodiscard]] static int row(const Point& p) {
    return row(std::sqrt(p.x() * p.x() + p.y() * p.y()), p.z());
  }

  /// The cell with this index().
  [[nodiscard]] static Cell at(std::size_t index) {
    return {static_cast<int>(index / kColumns), static_cast<int>(index % kColumns)};
  }

  [[nodiscard]] static Cell cell(const Point& p) { return {row(p), column(p.x(), p.y())}; }

 private:
  /// Whole degrees of `angle` (rad), counted from -`first` deg and kept in 0 .. count - 1; 0 for NaN.
  [[nodiscard]] static int whole(float angle, float first, int count) {
    constexpr float kPerRadian = 180.0F / std::numbers::pi_v<float>;
    const float degrees = angle * kPerRadian + first;
    return static_cast<int>(std::min(std::max(0.0F, degrees), static_cast<float>(count - 1)));
  }
};

}  // namespace hulltrack
