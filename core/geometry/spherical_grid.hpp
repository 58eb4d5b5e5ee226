// Directions from a sensor in cells of one degree: which cell does a point fall into?
//
// Rows are elevations from -90 deg, columns azimuths from -180 deg, about the z axis of the frame that
// the point is given in (L). Cells shrink towards the poles, where no spinning LiDAR looks.
// Pure; total (the origin falls into some cell, and so does what is no number). Cost: a few ns, no table.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

/// atan2 to 1e-5 rad (Abramowitz & Stegun 4.4.49 on the smaller octant), several times as fast.
[[nodiscard]] inline float fast_atan2(float y, float x) {
  constexpr float kHalfPi = std::numbers::pi_v<float> / 2.0F;
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float larger = std::max(ax, ay);
  const float q = larger > 0.0F ? std::min(ax, ay) / larger : 0.0F;
  const float s = q * q;
  float angle = q * (0.9998660F + s * (-0.3302995F + s * (0.1801410F + s * (-0.0851330F + s * 0.0208351F))));
  angle = ay > ax ? kHalfPi - angle : angle;
  angle = x < 0.0F ? std::numbers::pi_v<float> - angle : angle;
  return y < 0.0F ? -angle : angle;
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

  [[nodiscard]] static Cell cell(const Point& p) {
    constexpr float kPerRadian = 180.0F / std::numbers::pi_v<float>;
    const float azimuth = fast_atan2(p.y(), p.x()) * kPerRadian + 180.0F;
    const float elevation = fast_atan2(p.z(), std::sqrt(p.x() * p.x() + p.y() * p.y())) * kPerRadian + 90.0F;
    return {bounded(elevation, kRows), bounded(azimuth, kColumns)};
  }

  /// The whole part of `x`, from 0 to count - 1; 0 for NaN.
  [[nodiscard]] static int bounded(float x, int count) {
    return static_cast<int>(std::min(std::max(0.0F, x), static_cast<float>(count) - 0.5F));
  }
};

}  // namespace hulltrack
