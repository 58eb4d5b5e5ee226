// Where does the scan see the quay, against where it stands?
//
// The quay does not move in W, so what the scan finds beside its place says how far the sensor is from where
// joints and mounts put it, whatever the ship does. Two sources: the planes of a quay map, and the quay's top
// as one large plane. A return near a plane observes it. Besides, planes of the map are looked for along the
// scan's rays: those that rays have gone through are not where they should be.
// Returns on the hull are left out by its region; without one every return is looked at, and only a map can
// tell which are the quay's. The hull's drift within a scan is in the returns too (scan_filter.hpp): below
// 2 cm at hull.max_speed.
// Frames W and L, metres. Thread rule: one owner, scratch is kept. Cost: bounded, whatever the map's and the
// scan's size: kReturns returns and kProbes planes of each class a frame, others each frame.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/integrity/quay_top.hpp"
#include "core/map/quay_map.hpp"
#include "core/tracking/scan_view.hpp"
#include "core/tracking/surface_rays.hpp"

namespace hulltrack {

/// A piece of the quay that a return has met.
struct QuayObservation {
  Eigen::Vector3d p_W;  // where it is
  Eigen::Vector3d n_W;  // its unit normal
  double offset;        // n . (return - p), m
  SurfaceClass surface;
  std::uint32_t age;  // frames since then: 0 of the newest
};

/// Planes of the map of one class that rays reached.
struct QuayCount {
  std::uint32_t reached = 0;
  Cloud seen_through_W;  // middles of those that rays went through
};

struct QuaySighting {
  std::vector<QuayObservation> observations;        // of the last frames
  std::array<QuayCount, QuayMap::kClasses> planes;  // of this frame
  std::uint32_t asked = 0;  // returns of this frame that lie where the top is looked for, on it or not
  /// With a map: for how many returns of this frame that may be of the class each that was taken stands.
  std::array<double, QuayMap::kClasses> each_stands_for = {1.0, 1.0, 1.0, 1.0};
};

class QuaySight {
 public:
  static constexpr std::size_t kReturns = 300;  // a frame
  /// With a map kLookedUp returns are asked what they may be of, and of each class so many are taken: walls
  /// are rare and hold what the top does not.
  static constexpr std::size_t kLookedUp = 1000;
  static constexpr std::array<std::size_t, QuayMap::kClasses> kReturnsOf = {80, 80, 60, 40};
  static constexpr std::uint32_t kProbes = 300;  // a frame, class and LiDAR
  /// Observations are kept for so many frames, a second, and of each class the newest: few returns are of
  /// walls, and most of the quay's top.
  static constexpr std::uint32_t kFrames = 10;
  static constexpr std::size_t kOfClass = 100;
  static constexpr float kGate = QuayMap::kGate;
  static constexpr float kFarthest = 60.0F;  // m from the sensor

  /// `has_region`: the scan was cropped to the hull's region, so that what is outside is not hull.
  explicit QuaySight(bool has_region) : has_region_(has_region) {}

  /// What the scan shows of a map's planes. The answer lives until the next call.
  [[nodiscard]] const QuaySighting& look_for(const QuayMap& map, const FilteredScan& scan,
                                             std::span<const ScanView> views);

  /// The returns that the last look_for() of a map looked up.
  [[nodiscard]] const Cloud& looked_up_W() const { return looked_up_W_; }

  /// What these returns say of a map were the sensor where `T_true_said` puts what it measured (W to W), with
  /// what was observed earlier until forget(). At most so many of each class are taken.
  [[nodiscard]] const QuaySighting& look_elsewhere(const QuayMap& map, const Cloud& returns_W,
                                                   const Pose& T_true_said, std::size_t of_class);

  /// Of the quay's top, in the level extent of `area_W` if there is one. Precondition: there is a region.
  [[nodiscard]] const QuaySighting& look_for(const QuayPlane& top, const FilteredScan& scan,
                                             const Box* area_W = nullptr);

  /// For who does not know yet what to look for: the returns that a frame would be asked of.
  [[nodiscard]] const Cloud& returns_of(const FilteredScan& scan);

  /// What was observed is of other joints than what comes.
  void forget();

 private:
  void begin_frame();
  template <typename Take>
  void take_evenly(const FilteredScan& scan, std::size_t most, Take take) const;
  void choose_returns(const FilteredScan& scan);
  using OfClass = std::array<std::size_t, QuayMap::kClasses>;
  void choose_returns_near(const QuayMap& map, const Cloud& looked_up_W, const OfClass& most);
  void observe_planes(const QuayMap& map);
  void observe(SurfaceClass surface, const Point& return_W, const Eigen::Vector3d& n_W, double offset);
  const QuaySighting& gather();
  void look_through(const QuayMap& map, std::size_t surface, const ScanView& view);

  bool has_region_;
  std::uint32_t turn_ = 0;  // which part of the returns and planes is looked at
  Cloud looked_up_W_;
  Cloud returns_W_;
  std::array<Cloud, QuayMap::kClasses> candidates_W_;
  std::vector<Neighbour> nearest_;
  std::vector<RayEnd> rays_;
  struct Recent {
    std::uint32_t turn;
    QuayObservation observation;
  };
  std::array<std::deque<Recent>, QuayMap::kClasses> recent_;
  QuaySighting seen_;
};

}  // namespace hulltrack
