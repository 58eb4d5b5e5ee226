// What do the rays of one scan say about the map at one pose?
//
// Every visible flat map point (surfel) is checked along the sensor's own rays: the ray that meets its plane
// nearest to it, where did it really end?
//   confirmed     within kPlaneGate of the plane
//   contradicted  farther off the plane; seen through if more than kBehind behind it
//   hidden        more than kBehind before it, or less if the map has another surface there: not counted
// Surfels of landmarks (core/map/landmarks.hpp) and points on the rims of hatches are observed one by one,
// for those who judge over seconds. Frames W, H, L; metres. Pure. No failure. Cost: 0.2 us a visible point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/se3.hpp"
#include "core/map/hull_map.hpp"
#include "core/sight/scan_view.hpp"
#include "core/sight/surface_rays.hpp"
#include "core/sight/visibility.hpp"

namespace hulltrack {

/// Surfels of one class of surfaces: how many had a ray that counts, and how many were found in place.
struct SurfaceCount {
  std::uint32_t expected = 0;  // confirmed + contradicted
  std::uint32_t confirmed = 0;
  [[nodiscard]] double share() const { return expected == 0 ? 0.0 : double(confirmed) / double(expected); }
};

/// Surfels that a scan was asked about.
struct SurfelCounts {
  std::array<SurfaceCount, kSurfaceClasses> surfaces;
  std::uint32_t expected = 0;  // of all surfels, with a class or without
  std::uint32_t confirmed = 0;
  std::uint32_t seen_through = 0;  // part of those that are not confirmed
};

/// One surfel and what the rays around it found.
struct SurfelObservation {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  // where the pose puts the surfel
  Eigen::Vector3d n_W = Eigen::Vector3d::Zero();  // its normal
  double offset = 0.0;  // mean of n . (return - p), m: how far the surface really is along the normal
  double weight = 1.0;  // how many independent returns the mean is worth
};

/// What one ray, or one probe, says about a landmark. The pose's remaining error is not yet taken off.
struct LandmarkObservation {
  std::uint32_t landmark;
  SurfelObservation seen;  // kind on: all of it; through: only the normal; else nothing
  enum Kind : std::uint8_t { on, through, goes_on, ends } kind;  // the last two: over the hold beside a rim
};

/// A ray that ended on the top of a coaming, a rim, or went down beside it.
struct RimRay {
  const RimPoint* rim;
  float s;  // m across the rim: of the return, or if it went down: of where the ray meets the top's plane
  float offset;  // height of the return over the top, m
  bool through;  // it went down
};

struct PoseObservations {
  SurfelCounts counts;
  std::vector<SurfelObservation> surfels;
  std::vector<LandmarkObservation> landmarks;
  std::vector<RimRay> rim_rays;  // those of one rim point follow each other; they point into the map
};

namespace pose_observations {
inline constexpr float kPlaneGate = 0.15F;  // m
inline constexpr float kBehind = surface_rays::kBehind;
/// Surfaces are checked up to this distance from the sensor, m; the visible points have to reach as far. With
/// lasers 2 deg apart the lines of a scan are 1.4 m apart there, and every fourth surfel still has a ray
/// within reach.
inline constexpr double kSight = 40.0;
}  // namespace pose_observations

/// Asks the rays about each visible probe: surfels and rim points. `visible`: of map.probes_H(), at the pose
/// T_W_H.
[[nodiscard]] PoseObservations observe_pose(const HullMap& map, std::span<const VisiblePoint> visible,
                                            const Pose& T_W_H, std::span<const ScanView> views);

}  // namespace hulltrack
