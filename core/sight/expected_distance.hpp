// How large should Q1 be if the hull lies exactly at the pose and all of it is there?
//
// Q1 is the 25th percentile of the distances from visible map points to their nearest returns. A visible map
// point lies between the sensor's rays, so its nearest return is about where the nearest ray meets the
// point's plane. How far that is depends on the sensor, the range and the slope, not on the pose's error.
// Steps:
//   1. Take visible flat map points (surfels), and the rays of every LiDAR that sees them unhidden. Every ray
//      with a return counts, wherever it ended: one that a raindrop stopped tells where a return should be.
//   2. Per surfel: the distance to where the nearest ray meets its plane; with no ray near, the distance
//      within which rays were looked for.
//   3. Answer: the 25th percentile, with the noise of a range added.
// Frames W, H, L; metres. Thread rule: one owner, scratch is kept. Cost: 0.15 ms, bounded by kSamples.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/se3.hpp"
#include "core/map/hull_map.hpp"
#include "core/sight/scan_view.hpp"
#include "core/sight/visibility.hpp"

namespace hulltrack {

class ExpectedDistance {
 public:
  /// With fewer surfels than kFewest there is no figure; of more than kSamples every n-th is used. Between
  /// scan lines the quartile of n distances has a sigma of sqrt(3 / n) of its value: a twentieth for 1000; a
  /// quarter for 50, which is half the way from the right Q1 to 1.5 times it.
  static constexpr std::size_t kFewest = 50;
  static constexpr std::size_t kSamples = 1000;
  /// Added in quadrature to the distance between rays: a return lies off the surface by the sensor's range
  /// error. Makers state +-3 cm, which is taken as 1 sigma.
  static constexpr double kRangeNoise = 0.03;  // m

  /// The expected Q1, m; nothing if too few surfels are visible. A ray counts up to 0.3 m from a surfel, as
  /// far as the map is known to be flat there. If three quarters of the surfels have no ray so near in the
  /// cells around them, the answer is a lower bound: Q1 over it is then too large rather than too small.
  /// `visible`: of map.probes_H(), at the pose T_W_H.
  [[nodiscard]] std::optional<double> q1(const HullMap& map, std::span<const VisiblePoint> visible,
                                         const Pose& T_W_H, std::span<const ScanView> views);

  /// Did the last q1() have fewer surfels than kFewest? The hull is then far away or mostly hidden, and the
  /// missing figure says nothing about the rays.
  [[nodiscard]] bool had_few_surfels() const { return between2_.size() < kFewest; }

 private:
  std::vector<float> between2_;  // per surfel: squared distance from the nearest ray in its plane, m^2
};

}  // namespace hulltrack
