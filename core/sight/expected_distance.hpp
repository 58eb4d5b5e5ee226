// How large should Q1 be, if the hull is where the pose says and all of it is there?
//
// A map point that is in view lies between the sensor's rays, so its nearest return is about as far away as
// the place where the nearest ray meets its plane. How far that is depends on the sensor, on the range and on
// the slope, not on the pose's error. Every ray that gave a return counts, wherever it ended: one that a
// raindrop stopped tells where a return should have been. Visible flat map points (surfels) are asked for the
// rays of every LiDAR whose sight of them is free; with none near, a surfel counts as just that far from them
// as has been looked. Frames W, H, L; metres. Thread rule: one owner, scratch is kept. Cost: 0.15 ms, bounded
// by kSamples.
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
  /// Surfels that the figure stands on: fewer and there is none; of more, evenly taken ones. Between lines
  /// the quartile of n is sure to sqrt(3 / n) of itself, 1 sigma: of 50 to a quarter, half of what lies
  /// between the right Q1 and 1.5 times it; of 1000 to a twentieth.
  static constexpr std::size_t kFewest = 50;
  static constexpr std::size_t kSamples = 1000;
  /// 1 sigma of what else is between a map point and a return: the +-3 cm of range that makers state.
  static constexpr double kRangeNoise = 0.03;  // m

  /// 25th percentile, m; nothing if too few surfels are visible. At most 0.3 m, as far as a surfel is known
  /// to be flat: where three quarters of them have no ray that near in the cells around, it is a lower bound.
  /// The ratio of Q1 to it is then too large rather than too small. `visible`: of map.probes_H(), at the pose
  /// T_W_H.
  [[nodiscard]] std::optional<double> q1(const HullMap& map, std::span<const VisiblePoint> visible,
                                         const Pose& T_W_H, std::span<const ScanView> views);

  /// Did the last q1() have fewer than kFewest surfels to ask? That the figure is missing then says nothing
  /// about the rays: the hull is far away, or most of it is hidden.
  [[nodiscard]] bool had_few_surfels() const { return between2_.size() < kFewest; }

 private:
  std::vector<float> between2_;  // per surfel: squared distance from the nearest ray in its plane, m^2
};

}  // namespace hulltrack
