// Is this the ship of the map? What the scans of the last seconds say about each of its patches.
//
// For each patch of the map (core/map/patches.hpp) a histogram of how far along its normal the rays really
// ended, once the pose's own remaining error is taken off. From it:
//   in place    coherent and within kDisplaced of its plane
//   displaced   coherent and farther off: a surface like the mapped one stands elsewhere - another ship
//   gone        most rays go clearly through: a cover that moved, a fitting that was removed; a coaming is
//               neither, so that a rim which is gone stands elsewhere too
//   scattered   no one surface: cargo against a wall, things on deck, dust
//   covered     a rim that is higher and goes on over the hold: a cover lies on it
//   set back    a coaming's wall that most rays find behind its place: whatever was put before a wall or
//               taken from it since, it does not stand back
// Only displaced ones and those set back speak against the ship; for her speak structures that are in place
// (structures.hpp). Hull frame, metres. State: kBins + 3 floats a patch, forgotten as new returns of the same
// patch come in (kMemory), all of it by reset(). Thread rule: one owner. Cost: a few ns an observation, 50 ns
// a patch in view.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/integrity/strip_evidence.hpp"
#include "core/integrity/structures.hpp"
#include "core/map/patches.hpp"

namespace hulltrack {

enum class PatchState : std::uint8_t { unknown, in_place, displaced, gone, scattered, covered, set_back };

struct PatchFinding {
  PatchState state = PatchState::unknown;
  double offset = 0.0;     // m, median
  double coherence = 0.0;  // share of the returns within kCoherent of it
  double returns = 0.0;    // that it stands on
};

/// Over the patches that have been judged.
struct PatchReport {
  std::uint32_t in_view = 0;         // seen in this frame
  std::uint32_t judged = 0;          // of those in view: not unknown
  std::uint32_t solid = 0;           // in place or displaced, seen in this frame or remembered
  std::uint32_t displaced = 0;       // part of the solid; those set back are displaced too
  std::uint32_t displaced_rims = 0;  // part of the displaced
  std::uint32_t set_back = 0;        // likewise
  double median_offset = 0.0;        // of those of them whose offset is known, absolute, m
  StructureCount along;              // by the solid ones that say so
  StructureCount across;
  std::uint32_t rims_in_place = 0;  // at their height
  bool decided = false;             // since reset() enough of the ship has been judged
};

class PatchEvidence {
 public:
  static constexpr double kReach = 0.5;  // m: farther off a plane is another surface
  static constexpr int kBins = 40;       // from -kReach to kReach

  /// Forgets everything; `mapped` by number.
  void reset(std::vector<MapPatch> mapped);
  [[nodiscard]] std::uint32_t patches() const { return static_cast<std::uint32_t>(patches_.size()); }

  void begin_frame() { ++frame_; }
  /// Since the last frame the pose was put elsewhere by `jump_H` (m), which no motion of the hull explains:
  /// what was seen in place by then and not since stands aside of the new pose by as much. Returns of before
  /// are dropped.
  void put_elsewhere(const Point& jump_H);
  /// `returns` independent ones that lie `offset` (m, |offset| <= kReach) along the patch's normal.
  void add_offset(std::uint32_t patch, double offset, double returns);
  /// A ray that went through.
  void add_through(std::uint32_t patch);
  /// Whether the surface goes on, as high as it was found here, over the hold beside it.
  void add_beside(std::uint32_t patch, bool goes_on);

  /// A ray on the top of a rim, or through the air beside it, at `s` across (m).
  void add_across(const RimPoint& rim, float s, bool on);

  [[nodiscard]] PatchFinding judge(std::uint32_t patch) const;
  [[nodiscard]] StripEvidence::Finding judge_strip(std::uint32_t patch) const;
  [[nodiscard]] PatchReport report();

 private:
  struct Looks {
    std::array<float, kBins> offsets{};
    float through = 0.0F;
    float goes_on = 0.0F;
    float ends = 0.0F;
    std::uint32_t last_frame = 0;
  };
  struct Strip {
    StripEvidence evidence;
    float begin = 0.0F;  // as mapped, m
    float end = 0.0F;
    std::uint32_t last_frame = 0;
  };
  Looks& touch(std::uint32_t patch);

  std::vector<Looks> patches_;
  std::vector<MapPatch> mapped_;
  Structures structures_;                            // of the map
  bool has_rims_ = false;                            // the map
  std::unordered_map<std::uint32_t, Strip> strips_;  // of the patches that are rims
  struct Verdict {
    PatchState state = PatchState::unknown;  // as of the last frame that saw enough
    bool off_plane = false;                  // displaced, until it is seen in place, gone or covered
    bool set_back = false;                   // until it is seen in place
    bool aside = false;                      // a rim across its length, until it is seen in place
    bool in_line = false;                    // a rim across its length, until it is seen aside
    float by = 0.0F;                         // m; 0 = unknown
    Point jumps_H = Point::Zero();           // of the pose, all of them until the patch was judged
    Point strip_jumps_H = Point::Zero();     // likewise, until it was judged across
  };
  void judge_again(std::uint32_t patch);
  void judge_strip_again(std::uint32_t patch);
  void vote(std::uint32_t patch);
  [[nodiscard]] bool has_seen_enough(const PatchReport& report) const;

  std::vector<Verdict> verdicts_;
  std::uint32_t frame_ = 0;
  std::uint32_t frames_ = 0;       // that showed patches
  Point jumps_H_ = Point::Zero();  // of the pose, summed up
  bool decided_ = false;
};

}  // namespace hulltrack
