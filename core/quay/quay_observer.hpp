// What do returns say of the quay's surfaces, and what did those of the last second?
//
// A return near a plane of a quay map, or near the quay's top, observes it: by its offset along the plane's
// normal. Walls are few and most returns lie on the top, so of each class of surfaces some are taken, and
// the newest are kept. Frame W, metres. Thread rule: one owner, scratch is kept. Cost: bounded by the number
// of returns that it is shown, whatever the map's size.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "core/quay/quay_map.hpp"
#include "core/quay/quay_top.hpp"

namespace hulltrack {

/// A piece of the quay that a return has met.
struct QuayObservation {
  Eigen::Vector3d p_W;  // where it is
  Eigen::Vector3d n_W;  // its unit normal
  double offset;        // n . (return - p), m
  SurfaceClass surface;
  std::uint32_t age;  // frames since then: 0 of the newest
};

struct QuayObservations {
  std::vector<QuayObservation> all;  // of the last frames
};

class QuayObserver {
 public:
  /// Observations are kept for so many frames, a second, and of each class so many, the newest.
  static constexpr std::uint32_t kFrames = 10;
  static constexpr std::size_t kOfClass = 100;
  static constexpr float kGate = QuayMap::kGate;
  using OfClass = std::array<std::size_t, QuayMap::kClasses>;

  /// Shows it returns of a frame; at most so many that may be of each class are held against planes: evenly,
  /// others each frame. The answer lives until the next call.
  [[nodiscard]] const QuayObservations& observe(const QuayMap& map, const Cloud& returns_W,
                                                const OfClass& most);
  /// Of the quay's top, by all of the returns.
  [[nodiscard]] const QuayObservations& observe(const QuayPlane& top, const Cloud& returns_W);

  /// What was observed is of other joints than what comes.
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
