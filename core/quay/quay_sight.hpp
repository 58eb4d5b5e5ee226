// Where does the scan see the quay, compared with where the map, or the quay's top, has it?
//
// The quay does not move in W. So an offset of the quay shows how far the sensor is from where joints and
// mounts put it, whatever the ship does.
// - It picks the returns that may be the quay's. With a region of the hull these are the returns outside of
//   it. Without one they are all returns, and only a map can tell which are the quay's.
// - It compares these with the planes of the quay map, or with the quay's top as one large plane. The outcome
//   is observations (quay_observer.hpp).
// - With a map it also counts the planes that rays have passed through: they are not where they should be.
// The scan filter moves all returns along with the hull's drift within a scan (scan_filter.hpp), the quay's
// too: an error below 2 cm at hull.max_speed.
//
// Frames W and L, metres. Thread rule: one owner, scratch is kept. No failure: without a sight of the quay
// the counts are 0. Cost: bounded by kLookedUp and kProbes, whatever the map's and the scan's size; other
// returns and planes are looked at each frame.
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

/// Planes of one class of the map, in one frame.
struct QuayCount {
  std::uint32_t reached = 0;  // planes with a ray that ended near or behind them
  Cloud seen_through_W;       // middles of the planes that a ray has passed through
};

struct QuaySighting {
  const QuayObservations* observed = nullptr;       // of the last frames; lives as long as the QuaySight
  std::array<QuayCount, QuayMap::kClasses> planes;  // of this frame; 0 without a map
  std::size_t asked = 0;  // returns of this frame within the top's area, on the top or not; 0 with a map
};

class QuaySight {
 public:
  /// Without a map at most this many returns a frame are compared with the top.
  static constexpr std::size_t kReturns = 300;
  /// With a map at most this many returns a frame are looked up for the class that they may be of. These are
  /// all of them where a LiDAR of 16 lasers looks at a ship. Where walls are few, a third of the returns
  /// leaves travel unseen; all of them hold it to 0.17 m.
  static constexpr std::size_t kLookedUp = 3000;
  /// Of each class at most so many of them are compared with planes, by SurfaceClass. Walls are rare, and
  /// hold directions that the top does not.
  static constexpr QuayObserver::OfClass kReturnsOf = {80, 80, 60, 40};
  /// Planes of each class that each LiDAR looks for in a frame: about so many, and fewer than twice as many.
  static constexpr std::uint32_t kProbes = 150;
  static constexpr float kFarthest = 60.0F;  // planes farther than this from the sensor are left out, m

  /// `has_region`: the scan was cropped to the hull's region, so that returns outside of it are not hull.
  explicit QuaySight(bool has_region) : has_region_(has_region) {}

  /// What the scan shows of the map's planes. The answer lives until the next call.
  /// `E` moves what stands still in W to where the scan has it, as far as is known (misplacement.hpp): planes
  /// are looked for along rays there. A worn machine's rays would miss narrow ones at their mapped place.
  [[nodiscard]] const QuaySighting& look_for(const QuayMap& map, const FilteredScan& scan,
                                             std::span<const ScanView> views, const Pose& E);

  /// What the scan shows of the quay's top, within the X and Y of `area_W` if that is given. Precondition:
  /// there is a region.
  [[nodiscard]] const QuaySighting& look_for(const QuayPlane& top, const FilteredScan& scan,
                                             const Box* area_W = nullptr);

  /// The returns that would be compared with the top, for a caller that has yet to find it. Drops all
  /// observations.
  [[nodiscard]] const Cloud& returns_of(const FilteredScan& scan);

  /// The returns of the last call.
  [[nodiscard]] const Cloud& returns_W() const { return returns_W_; }

  /// Drops all observations: the joints may have changed.
  void forget() { observer_.forget(); }

 private:
  void begin_frame(const FilteredScan& scan, std::size_t most);
  void look_through(const QuayMap& map, std::size_t surface, const ScanView& view,
                    const Eigen::Isometry3f& E);

  bool has_region_;
  std::uint32_t turn_ = 0;  // number of the frame: decides which returns and planes are looked at
  QuayObserver observer_;
  QuaySighting seen_;
  // Scratch:
  Cloud returns_W_;
  std::vector<RayEnd> rays_;
};

}  // namespace hulltrack
