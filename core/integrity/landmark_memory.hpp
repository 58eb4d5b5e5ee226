// Is this the ship of the map? What the scans of the last seconds say about each of its landmarks.
//
// A landmark is a flat piece of the map of a few metres, or a piece of a rim, the top of a hatch's coaming
// (see core/map/landmarks.hpp). Input: how far along the landmark's normal the rays ended, once the pose's
// own remaining error is taken off. A histogram of these offsets for each landmark gives its state:
//   in place    coherent (one surface), its median offset within kDisplaced
//   displaced   coherent and farther off: a surface like the mapped one stands elsewhere - another ship
//   gone        more than kMostThrough of the rays go clearly through: a cover moved, a fitting was removed;
//               a coaming cannot be, so that a rim which is gone counts as displaced
//   scattered   no one surface: cargo against a wall, things on deck, dust
//   covered     a rim's surface is higher and goes on over the hold: a cover lies on it
//   set back    more than half of the rays find a coaming's wall at least kSetBack behind its place: nothing
//               that is put before a wall or taken from it does that
// Only displaced ones and those set back speak against the ship; for her speak structures that are in place
// (structures.hpp). Hull frame, metres. State: kBins + 3 floats a landmark; old returns fade as new ones of
// the same landmark come in (kMemory), reset() forgets all. Thread rule: one owner. Cost: a few ns an
// observation, 50 ns a landmark in view.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/integrity/rim_memory.hpp"
#include "core/integrity/structures.hpp"
#include "core/map/landmarks.hpp"

namespace hulltrack {

enum class LandmarkState : std::uint8_t { unknown, in_place, displaced, gone, scattered, covered, set_back };

struct LandmarkFinding {
  LandmarkState state = LandmarkState::unknown;
  double offset = 0.0;     // m, median
  double coherence = 0.0;  // share of the returns within kCoherent of the median
  double returns = 0.0;    // returns and rays gone through that the state rests on
};

/// What the landmarks say together, as of the last frame.
struct LandmarkReport {
  std::uint32_t in_view = 0;         // seen in this frame
  std::uint32_t judged = 0;          // part of those in view: any state but unknown
  std::uint32_t solid = 0;           // in place or displaced, seen in this frame or remembered
  std::uint32_t displaced = 0;       // part of the solid; those set back are displaced too
  std::uint32_t displaced_rims = 0;  // part of the displaced
  std::uint32_t set_back = 0;        // part of the displaced
  double median_offset = 0.0;        // of the displaced whose offset is known, absolute, m; 0 = of none
  StructureCount along;              // by the votes of landmarks that tell the place along the ship
  StructureCount across;             // the same across her
  std::uint32_t rims_in_place = 0;   // pieces of rims at their mapped height
  bool decided = false;              // enough of the ship was judged, in this frame or earlier since reset()
};

class LandmarkMemory {
 public:
  static constexpr double kReach = 0.5;  // m: farther off a plane is another surface
  static constexpr int kBins = 40;       // from -kReach to kReach

  /// Forgets everything; `mapped` by number.
  void reset(std::vector<Landmark> mapped);
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(histograms_.size()); }

  void begin_frame() { ++frame_; }
  /// The pose has jumped by `jump_H` (m) since the last frame, which no motion of the hull explains.
  /// Histograms are emptied. A landmark in place before counts as displaced by the jump until judged again.
  void put_elsewhere(const Point& jump_H);
  /// Returns that lie `offset` (m, |offset| <= kReach) along the landmark's normal, worth `returns`
  /// independent ones.
  void add_offset(std::uint32_t landmark, double offset, double returns);
  /// A ray that went through the landmark.
  void add_through(std::uint32_t landmark);
  /// Whether a surface found on a rim goes on at the same height over the hold beside it, as a cover does.
  void add_beside(std::uint32_t landmark, bool goes_on);

  /// A ray that ended on the top of a rim (`on`) or went down beside it, at `s` across (m).
  void add_across(const RimPoint& rim, float s, bool on);

  [[nodiscard]] LandmarkFinding judge(std::uint32_t landmark) const;
  [[nodiscard]] RimMemory::Finding judge_rim(std::uint32_t landmark) const;
  [[nodiscard]] LandmarkReport report();

 private:
  struct Histogram {
    std::array<float, kBins> offsets{};
    float through = 0.0F;
    float goes_on = 0.0F;
    float ends = 0.0F;
    std::uint32_t last_frame = 0;
  };
  struct Rim {
    RimMemory rays;
    float begin = 0.0F;  // edges as mapped, m
    float end = 0.0F;
    std::uint32_t last_frame = 0;
  };
  Histogram& touch(std::uint32_t landmark);

  std::vector<Histogram> histograms_;
  std::vector<Landmark> mapped_;
  Structures structures_;                        // of the map
  bool has_rims_ = false;                        // the map
  std::unordered_map<std::uint32_t, Rim> rims_;  // of the landmarks that are rims
  struct Verdict {
    LandmarkState state = LandmarkState::unknown;  // the last one but unknown
    bool off_plane = false;             // displaced along its normal; until in place, covered or gone
    bool set_back = false;              // until it is seen in place
    bool aside = false;                 // a rim, displaced across its length; until seen in line
    bool in_line = false;               // a rim, in place across its length; until seen aside
    float by = 0.0F;                    // how far it is displaced, m; 0 = unknown
    Point jumps_H = Point::Zero();      // LandmarkMemory::jumps_H_ when `state` was found
    Point rim_jumps_H = Point::Zero();  // the same for `aside` and `in_line`
  };
  void judge_again(std::uint32_t landmark);
  void judge_rim_again(std::uint32_t landmark);
  void vote(std::uint32_t landmark);
  [[nodiscard]] bool has_seen_enough(const LandmarkReport& report) const;

  std::vector<Verdict> verdicts_;
  std::uint32_t frame_ = 0;
  std::uint32_t frames_ = 0;       // frames that showed landmarks
  Point jumps_H_ = Point::Zero();  // sum of the pose's jumps since reset(), m
  bool decided_ = false;
};

}  // namespace hulltrack
