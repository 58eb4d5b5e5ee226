// Compares returns with the quay's surfaces, and keeps the observations of the last second.
//
// An observation is a return near a plane of the quay map, or near the quay's top, with its offset along the
// plane's normal. Most returns lie on the top and few on walls. So a limited number of returns is compared
// for each class of surfaces, and a limited number of observations is kept, the newest ones. Frame W, metres.
// Thread rule: one owner, scratch is kept. No failure: without returns near planes there are no observations.
// Cost: bounded by the number of returns, whatever the map's size.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "core/quay/quay_map.hpp"
#include "core/quay/quay_top.hpp"

namespace hulltrack {

/// A place of the quay's surface that a return has met.
struct QuayObservation {
  Eigen::Vector3d p_W;  // the place: the return's foot on the plane
  Eigen::Vector3d n_W;  // the plane's unit normal
  double offset;        // n . (return - p), m
  SurfaceClass surface;
  std::uint32_t age;  // frames since the return was measured: 0 is the newest frame
};

struct QuayObservations {
  std::vector<QuayObservation> all;  // of the last kFrames frames
};

class QuayObserver {
 public:
  static constexpr std::uint32_t kFrames = 10;  // observations are kept for so many frames: one second
  static constexpr std::size_t kOfClass = 100;  // and of each class only so many, the newest
  static constexpr float kGate = QuayMap::kGate;
  using OfClass = std::array<std::size_t, QuayMap::kClasses>;

  /// Takes the returns of one frame. At most `most` of each class are compared with planes: evenly spaced,
  /// and different ones each frame. The answer lives until the next call.
  [[nodiscard]] const QuayObservations& observe(const QuayMap& map, const Cloud& returns_W,
                                                const OfClass& most);
  /// The same against the quay's top; all returns are compared.
  [[nodiscard]] const QuayObservations& observe(const QuayPlane& top, const Cloud& returns_W);

  /// Drops all observations: the joints may have changed, and old and new ones do not belong together.
  void forget();

 private:
  void choose(const QuayMap& map, const Cloud& returns_W, const OfClass& most);
  void keep(SurfaceClass surface, const Point& return_W, const Eigen::Vector3d& n_W, double offset);
  const QuayObservations& gather();

  std::uint32_t frame_ = 0;
  struct Recent {
    std::uint32_t frame;
    QuayObservation observation;
  };
  std::array<std::deque<Recent>, QuayMap::kClasses> recent_;
  QuayObservations observations_;
  // Scratch:
  std::vector<SurfaceCells::Classes> near_;
  std::array<Cloud, QuayMap::kClasses> candidates_W_;
  Cloud chosen_W_;
  std::vector<Neighbour> nearest_;
};

}  // namespace hulltrack
