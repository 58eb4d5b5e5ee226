// Where does the scan see the quay, against where it stands?
//
// The quay does not move in W, so what the scan finds beside its place says how far the sensor is from where
// joints and mounts put it, whatever the ship does. Two sources: the planes of a quay map, and the quay's top
// as one large plane. Returns near them observe them (quay_observer.hpp). Besides, planes of the map are
// looked for along the scan's rays: those that rays have gone through are not where they should be.
// Returns on the hull are left out by its region; without one every return is looked at, and only a map can
// tell which are the quay's. The hull's drift within a scan is in the returns too (scan_filter.hpp): below
// 2 cm at hull.max_speed.
// Frames W and L, metres. Thread rule: one owner, scratch is kept. Cost: bounded, whatever the map's and the
// scan's size: kLookedUp returns and kProbes planes of each class a frame, others each frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/quay/quay_observer.hpp"
#include "core/sight/scan_view.hpp"
#include "core/sight/surface_rays.hpp"

namespace hulltrack {

/// Planes of the map of one class that rays reached.
struct QuayCount {
  std::uint32_t reached = 0;
  Cloud seen_through_W;  // middles of those that rays went through
};

struct QuaySighting {
  const QuayObservations* observed = nullptr;       // of the last frames; lives as long as the sight
  std::array<QuayCount, QuayMap::kClasses> planes;  // of this frame
  std::size_t asked = 0;  // returns of this frame that lie where the top is looked for, on it or not
};

class QuaySight {
 public:
  /// Returns that the top is looked for in, a frame.
  static constexpr std::size_t kReturns = 300;
  /// With a map kLookedUp returns are asked what they may be of, and of each class so many are taken: walls
  /// are rare and hold what the top does not. All of them where a LiDAR of 16 lasers looks at a ship: where
  /// walls are few, a third of them leaves travel unseen that all of them hold to 0.17 m.
  static constexpr std::size_t kLookedUp = 3000;
  static constexpr QuayObserver::OfClass kReturnsOf = {80, 80, 60, 40};
  static constexpr std::uint32_t kProbes = 150;  // a frame, class and LiDAR
  static constexpr float kFarthest = 60.0F;      // m from the sensor

  /// `has_region`: the scan was cropped to the hull's region, so that what is outside is not hull.
  explicit QuaySight(bool has_region) : has_region_(has_region) {}

  /// What the scan shows of a map's planes. The answer lives until the next call.
  [[nodiscard]] const QuaySighting& look_for(const QuayMap& map, const FilteredScan& scan,
                                             std::span<const ScanView> views);

  /// Of the quay's top, in the level extent of `area_W` if there is one. Precondition: there is a region.
  [[nodiscard]] const QuaySighting& look_for(const QuayPlane& top, const FilteredScan& scan,
                                             const Box* area_W = nullptr);

  /// For who does not know yet what to look for: the returns that the top would be looked for in. Forgets
  /// what was observed.
  [[nodiscard]] const Cloud& returns_of(const FilteredScan& scan);

  /// The returns of the last call.
  [[nodiscard]] const Cloud& returns_W() const { return returns_W_; }

  /// What was observed is of other joints than what comes.
  void forget() { observer_.forget(); }

 private:
  void begin_frame(const FilteredScan& scan, std::size_t most);
  void look_through(const QuayMap& map, std::size_t surface, const ScanView& view);

  bool has_region_;
  std::uint32_t turn_ = 0;  // which part of the returns and planes is looked at
  QuayObserver observer_;
  QuaySighting seen_;
  // Scratch:
  Cloud returns_W_;
  std::vector<RayEnd> rays_;
};

}  // namespace hulltrack
