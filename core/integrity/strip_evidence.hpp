// Does a coaming's top lie where the map has it, across its length? By its two edges.
//
// Rays that meet the plane of a strip near it end on it or go down beside it: two histograms across the
// strip, of those that ended on it and of those that went through. The strip's shift is the one that leaves
// the fewest rays contradicting: through inside of it, on it outside. A cover or cargo at its height
// contradicts on one side only and moves nothing. Hull frame, metres across the strip towards the hold.
// State: 2 kBins floats a strip, forgotten as new rays come in (kMemory). Thread rule: one owner. Cost: 0.1
// us a strip in view.
#pragma once

#include <array>
#include <cstdint>

namespace hulltrack {

class StripEvidence {
 public:
  static constexpr float kAside = 0.3F;  // m to either side of the strip's middle

  struct Finding {
    bool known = false;
    double shift = 0.0;      // m
    double against = 0.0;    // rays that contradict the strip as it is mapped
    double explained = 0.0;  // of those, what the shift explains
    [[nodiscard]] bool displaced() const;
    [[nodiscard]] bool in_place() const;
  };

  /// Before the rays of a new frame: forgets so that kMemory rays are left at most.
  void begin_frame();
  /// `s` in -kAside .. kAside; others are left out.
  void add(float s, bool on);
  /// For a strip that is mapped from `begin` to `end`.
  [[nodiscard]] Finding judge(float begin, float end) const;

 private:
  static constexpr float kBin = 0.0125F;  // m
  static constexpr int kBins = 48;
  std::array<float, kBins> on_{};
  std::array<float, kBins> through_{};
};

}  // namespace hulltrack
