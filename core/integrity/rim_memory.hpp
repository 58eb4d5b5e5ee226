// Does a coaming's top lie where the map has it, across its length? Its two edges tell.
//
// A rim is the top of one straight piece of coaming. Input: rays that meet the plane of the top in or near
// the rim. Each one ended on the top or went down beside it; two histograms across the rim count the two
// kinds. A ray contradicts the rim if it went down between the edges or ended at the top's height outside
// of them. Output: the shift of both edges that leaves the fewest rays contradicting. A cover or cargo at the
// same height contradicts beside one edge only, so that it does not change the shift.
// Hull frame; metres across the rim, + towards the hold. State: 2 kBins floats a rim; old rays fade as
// new ones come in (kMemory). Thread rule: one owner. Cost: 0.1 us a rim in view.
#pragma once

#include <array>
#include <cstdint>

namespace hulltrack {

class RimMemory {
 public:
  static constexpr float kAside = 0.3F;  // m to either side of the rim's middle

  struct Finding {
    bool known = false;
    double shift = 0.0;      // m
    double against = 0.0;    // rays that contradict the rim at its mapped place
    double explained = 0.0;  // how many fewer contradict it at the shift
    [[nodiscard]] bool displaced() const;
    [[nodiscard]] bool in_place() const;
  };

  /// Call it before the rays of a new frame. Scales the counts down to kMemory rays at most.
  void begin_frame();
  /// A ray at `s` (m) that ended on the top (`on`) or went down. Outside of -kAside .. kAside it is ignored.
  void add(float s, bool on);
  /// For a rim whose mapped edges are at `begin` and `end`, m.
  [[nodiscard]] Finding judge(float begin, float end) const;

 private:
  static constexpr float kBin = 0.0125F;  // m
  static constexpr int kBins = 48;
  std::array<float, kBins> on_{};
  std::array<float, kBins> through_{};
};

}  // namespace hulltrack
