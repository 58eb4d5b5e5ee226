// What did the rays find that a scan sent towards a small flat piece of surface?
//
// A ray that would meet the surface's plane near the piece is looked at where it really ended: on the plane,
// off it, behind it (seen through). Rays that something stopped clearly before it say nothing. Frame L of the
// sensor, metres. Thread rule: pure, but for the caller's scratch. Cost: the returns of nine cells.
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
inline constexpr float kBehind = 0.7F;        // m: a return so much behind a plane has seen through it
inline constexpr float kSameSurface = 0.06F;  // m: three sigma of a return beside the nearest one
inline constexpr float kGrazing = 0.1F;       // sine of 6 deg: below it a range says little about the plane
}  // namespace surface_rays

/// Every ray that meets the plane within kSurfelRadius of the piece, as far as it is known to be flat, and
/// was not stopped kBehind before it. `p_L`: the piece's middle, n_L: its unit normal. `rays` is replaced.
void collect_rays(const ScanView& view, const Point& p_L, const Point& n_L, std::vector<RayEnd>& rays);

/// The ray that meets the plane nearest to the piece's middle; nullptr without rays.
[[nodiscard]] const RayEnd* nearest_ray(const std::vector<RayEnd>& rays);

/// Mean offset (m) of the returns that lie on the same surface as the nearest ray's, and how many independent
/// returns that mean is worth.
[[nodiscard]] std::pair<double, double> mean_offset(const std::vector<RayEnd>& rays, const RayEnd& nearest);

}  // namespace hulltrack
