// Where does the dust of pouring ore stop a beam? A turbulent plume around the chute's end.
//
// The plume is a cone in W, upright, from somewhat above the chute's end into the hold; its density there is
// noise that is smooth over a metre and a half and drifts with the air (frozen turbulence), so that
// neighbouring beams and successive scans meet the same puffs. It rises within some seconds when the loader
// stands and pours and settles when it moves on. Metres, seconds from the first firing. Immutable after
// construction; any thread. A ray through the plume takes about 2 us, another one nothing.
#pragma once

#include <cstdint>
#include <optional>

#include "core/geometry/cloud.hpp"
#include "daemon/simulator/berth/loader_motion.hpp"
#include "daemon/simulator/random.hpp"

namespace hulltrack {

class DustPlume {
 public:
  /// What there is of it for the next millisecond.
  struct Now {
    double t;         // s
    Point top_W;      // m, the middle of the plume's upper end
    double strength;  // [0, 1]
  };

  /// How far above the chute's end dust rises, how deep the plume is from there, and its half width at the
  /// top and at the bottom; m.
  static constexpr float kRise = 5.0F;
  static constexpr float kDepth = 17.0F;
  static constexpr float kTopRadius = 3.0F;
  static constexpr float kBottomRadius = 8.0F;

  /// `density`: share of light lost a metre in the thick of a puff; 0 = no dust. `loader` must outlive this.
  DustPlume(double density, const LoaderMotion& loader, std::uint64_t seed)
      : density_(density), loader_(&loader), seed_(seed) {}

  [[nodiscard]] bool any() const { return density_ > 0.0; }
  [[nodiscard]] Now at(double t) const;

  /// Where along a ray (unit direction) dust stops it, if it does within `reach`.
  [[nodiscard]] std::optional<float> stops(const Now& now, const Point& origin_W, const Point& direction_W,
                                           float reach, RandomStream& random) const;

 private:
  [[nodiscard]] double density(const Now& now, const Point& p_W) const;
  [[nodiscard]] double noise(const Eigen::Vector3d& p) const;

  double density_;
  const LoaderMotion* loader_;
  std::uint64_t seed_;
};

}  // namespace hulltrack
