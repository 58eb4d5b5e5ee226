// What stands or moves on the quay that no map of it shows? Lorries, containers, hatch covers, people.
//
// Some were parked there since the quay was surveyed, one has left since; a lorry drives and two people walk
// to and fro. Which, where and when follow from the seed. Between and behind the rails, never on the strip at
// the edge, never in the portal's way. W, metres, seconds from the first firing. Pure.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/se3.hpp"
#include "daemon/simulator/sensing/mesh.hpp"

namespace hulltrack {

/// Parked since the survey; and what stood there then and has left. Each in W.
[[nodiscard]] TriangleMesh parked_now(std::uint64_t seed);
[[nodiscard]] TriangleMesh parked_at_survey(std::uint64_t seed);

/// Goes to and fro between `from` and `to` along x at constant speed; turns on the spot.
class Walk {
 public:
  Walk(double y, double from, double to, double speed, double start)
      : y_(y), from_(from), length_(to - from), speed_(speed), start_(start) {}

  /// Of its own frame, x along the quay, on the ground.
  [[nodiscard]] Pose T_W_own(double t) const;

 private:
  double y_, from_, length_, speed_;
  double start_;  // m of the way at time 0
};

struct Mover {
  TriangleMesh mesh;  // in its own frame
  Walk walk;
};
inline constexpr std::size_t kMovers = 3;
[[nodiscard]] std::array<Mover, kMovers> movers(std::uint64_t seed);

}  // namespace hulltrack
