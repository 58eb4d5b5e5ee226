// Where did the rays of a scan end that cross a small flat piece of surface: on it, off it, or behind it
// (seen through)?
//
// Of each ray that meets the surface's plane near the piece's middle: how far its return lies off the plane,
// and how far behind or before the plane along the ray. Rays that something stopped clearly before the plane
// say nothing and are left out. Frame L of the sensor, metres. Thread rule: pure, but for the caller's
// scratch. Cost: the returns of nine cells.
#pragma once

#include <utility>
#include <vector>

#include "core/sight/scan_view.hpp"

namespace hulltrack {

/// A ray that meets a surface's plane near the piece.
struct RayEnd {
  float besides2;  // squared distance from the piece's middle in its plane, m^2
  float offset;    // n . (return - p), m
  float depth;     // return's range minus the plane's along the same ray, m
};

namespace surface_rays {
inline constexpr float kBehind = 0.7F;        // m: a return this far behind a plane has seen through it
inline constexpr float kSameSurface = 0.06F;  // m: offsets this near are of one surface; 3 sigma of a return
inline constexpr float kGrazing = 0.1F;  // sine of 6 deg: flatter rays are left out, their range says little
}  // namespace surface_rays

/// Every ray that meets the plane within kSurfelRadius of the piece's middle, where the map is known to be
/// flat, unless it was stopped more than kBehind before the plane. `p_L`: the piece's middle, n_L: its unit
/// normal. `rays` is replaced.
void collect_rays(const ScanView& view, const Point& p_L, const Point& n_L, std::vector<RayEnd>& rays);

/// The ray that meets the plane nearest to the piece's middle; nullptr without rays.
[[nodiscard]] const RayEnd* nearest_ray(const std::vector<RayEnd>& rays);

/// Mean offset (m) of the returns on the same surface as the nearest ray's: within 0.2 m of the piece's
/// middle in the plane, with an offset within kSameSurface of the nearest's. And how many independent returns
/// this mean is worth.
[[nodiscard]] std::pair<double, double> mean_offset(const std::vector<RayEnd>& rays, const RayEnd& nearest);

}  // namespace hulltrack
