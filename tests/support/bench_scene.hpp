// A bulk carrier's map and the scans that a loader takes of it, at full size: the benchmarks' case.
//
// Everything is made of axis-aligned boxes and ray-cast exactly. The hull (120 x 20 m, five open holds with
// coamings and folded covers, superstructure, cranes, bulwark, fittings) is surveyed from the loader's
// positions: map points are on a 5 cm grid, where no survey ray reaches there is no point. Scans see hull and
// clutter: quay, cargo, chute, dust. Frames: H = W (the hull has not moved), metres; x along the ship, y away
// from the quay, z up. Deterministic for a seed. Cost: some seconds.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/box.hpp"
#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"

namespace hulltrack::bench {

struct SceneScan {
  Cloud cloud_W;                // noisy returns in firing order, m
  std::size_t hull_points = 0;  // returns from the hull; all others are clutter
};

struct Scene {
  Cloud map_H;
  std::vector<SceneScan> scans;
};

/// `spacing` of the map, m; `scans` scans of 65,536 rays each from positions along the ship.
[[nodiscard]] Scene make_scene(double spacing, std::size_t scans, std::uint32_t seed);

/// What a ray meets first.
struct RayHit {
  float range;  // m; infinity where there is nothing
  bool on_hull;
};

/// The scene's hull and clutter (without dust and chute) for rays of the caller's choice.
class RayTarget {
 public:
  RayTarget();
  /// `direction` is a unit vector. Of near faces only: a ray that starts inside a box does not meet it.
  [[nodiscard]] RayHit cast(const Point& from, const Point& direction) const;

 private:
  std::vector<Box> hull_;
  std::vector<Box> clutter_;
};

/// A start pose that is wrong by `translation` (m) at the ship's middle and by `angle` (rad), in random
/// directions.
[[nodiscard]] Pose start_pose(double translation, double angle, std::uint32_t seed);

}  // namespace hulltrack::bench
