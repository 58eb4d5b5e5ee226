#include "core/tracking/patch_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hulltrack {
namespace {

// A patch is judged on the last kMemory returns: with 3 cm of noise their median is good to 0.3 cm.
constexpr float kMemory = 200.0F;
constexpr double kFewest = 12.0;  // 1.25 * 3 cm / sqrt(12) = 1.1 cm of sigma: a third of kDisplaced
// Noise of 1.1 cm (three sigma: 3.3 cm) or the bend that a pose does not take out (a parabola of L/1000 of a
// ship of 120 m bends by 1 cm within 25 m) with the map's 0.5 cm.
constexpr double kDisplaced = 0.045;     // m
constexpr double kCoherent = 0.075;      // m: 2.5 sigma of a return
constexpr double kLeastCoherence = 0.8;  // one surface has 0.99; a fifth may meet its edges or things on it
constexpr double kMostThrough = 0.4;
constexpr double kMostGoesOn = 0.25;

// A statement about the ship needs most of what is in view, and a second look at what was seen by chance:
// what a frame of 16 lines leaves out the loader's motion and the noise show in the next ones.
constexpr std::uint32_t kFramesToDecide = 9;
constexpr std::uint32_t kFewestToDecide = 8;
constexpr double kShareToDecide = 0.75;

}  // namespace

void PatchEvidence::reset(std::uint32_t patches) {
  patches_.assign(patches, {});
  is_rim_.assign(patches, false);
  verdicts_.assign(patches, {});
  strips_.clear();
  frame_ = 0;
  frames_ = 0;
  decided_ = false;
}

PatchEvidence::Patch& PatchEvidence::touch(std::uint32_t patch) {
  Patch& p = patches_[patch];
  if (p.last_frame != frame_) {
    p.last_frame = frame_;
    const float total = std::accumulate(p.offsets.begin(), p.offsets.end(), p.through);
    if (total > kMemory) {
      const float keep = kMemory / total;
      for (float& bin : p.offsets) {
        bin *= keep;
      }
      p.through *= keep;
      p.goes_on *= keep;
      p.ends *= keep;
    }
  }
  return p;
}

void PatchEvidence::add_offset(std::uint32_t patch, double offset, double returns) {
  const int bin = static_cast<int>((offset + kReach) / (2.0 * kReach) * kBins);
  touch(patch).offsets[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))] +=
      static_cast<float>(returns);
}

void PatchEvidence::add_through(std::uint32_t patch) { touch(patch).through += 1.0F; }

void PatchEvidence::add_beside(std::uint32_t patch, bool goes_on) {
  Patch& p = touch(patch);
  (goes_on ? p.goes_on : p.ends) += 1.0F;
}

void PatchEvidence::add_across(const RimPoint& rim, float s, bool on) {
  Strip& strip = strips_[rim.patch];
  if (strip.last_frame != frame_) {
    strip.last_frame = frame_;
    strip.begin = rim.begin;
    strip.end = rim.end;
    strip.evidence.begin_frame();
  }
  strip.evidence.add(s, on);
}

StripEvidence::Finding PatchEvidence::judge_strip(std::uint32_t patch) const {
  const auto found = strips_.find(patch);
  return found == strips_.end() ? StripEvidence::Finding{}
                                : found->second.evidence.judge(found->second.begin, found->second.end);
}

PatchFinding PatchEvidence::judge(std::uint32_t patch) const {
  const Patch& p = patches_[patch];
  PatchFinding finding;
  const double on = std::accumulate(p.offsets.begin(), p.offsets.end(), 0.0);
  finding.returns = on + static_cast<double>(p.through);
  if (finding.returns < kFewest) {
    return finding;
  }
  if (static_cast<double>(p.through) > kMostThrough * finding.returns) {
    finding.state = PatchState::gone;
    return finding;
  }
  constexpr double kBin = 2.0 * kReach / kBins;
  double below = 0.0;
  std::size_t middle = 0;
  while (below + static_cast<double>(p.offsets[middle]) < 0.5 * on) {
    below += static_cast<double>(p.offsets[middle++]);
  }
  const double share = (0.5 * on - below) / static_cast<double>(p.offsets[middle]);
  finding.offset = (static_cast<double>(middle) + share) * kBin - kReach;
  double near = 0.0;
  for (std::size_t i = 0; i < p.offsets.size(); ++i) {
    const double centre = (static_cast<double>(i) + 0.5) * kBin - kReach;
    near += std::abs(centre - finding.offset) <= kCoherent ? static_cast<double>(p.offsets[i]) : 0.0;
  }
  finding.coherence = near / finding.returns;
  if (finding.coherence < kLeastCoherence) {
    finding.state = PatchState::scattered;
  } else if (std::abs(finding.offset) <= kDisplaced) {
    finding.state = PatchState::in_place;
  } else if (finding.offset > 0.0 && p.goes_on > kMostGoesOn * (p.goes_on + p.ends)) {
    finding.state = PatchState::covered;
  } else {
    finding.state = PatchState::displaced;
  }
  return finding;
}

void PatchEvidence::judge_again(std::uint32_t patch) {
  Verdict& verdict = verdicts_[patch];
  const PatchFinding plane = judge(patch);
  const StripEvidence::Finding strip = judge_strip(patch);
  verdict.state = plane.state;
  if (plane.state == PatchState::displaced) {
    verdict.off_plane = true;
    verdict.by = static_cast<float>(std::abs(plane.offset));
  } else if (plane.state == PatchState::gone && is_rim_[patch]) {
    verdict.off_plane = true;
    verdict.by = 0.0F;
  } else if (plane.state != PatchState::unknown && plane.state != PatchState::scattered) {
    verdict.off_plane = false;
  }
  if (strip.displaced()) {
    verdict.aside = true;
    verdict.by = static_cast<float>(std::abs(strip.shift));
  } else if (strip.in_place()) {
    verdict.aside = false;
  }
}

PatchReport PatchEvidence::report() {
  PatchReport report;
  std::vector<float> offsets;
  for (std::uint32_t i = 0; i < patches(); ++i) {
    const Verdict& verdict = verdicts_[i];
    if (patches_[i].last_frame == frame_) {
      judge_again(i);
      ++report.in_view;
      report.judged += verdict.state == PatchState::unknown ? 0 : 1;
    }
    const bool elsewhere = verdict.off_plane || verdict.aside;
    if (elsewhere) {
      ++report.displaced;
      report.displaced_rims += is_rim_[i] ? 1 : 0;
      if (verdict.by > 0.0F) {
        offsets.push_back(verdict.by);
      }
    }
    report.solid += elsewhere || verdict.state == PatchState::in_place ? 1 : 0;
  }
  frames_ += report.in_view > 0 ? 1 : 0;
  decided_ = decided_ || (frames_ >= kFramesToDecide && report.judged >= kFewestToDecide &&
                          report.judged >= kShareToDecide * report.in_view);
  report.decided = decided_;
  if (!offsets.empty()) {
    const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
    std::nth_element(offsets.begin(), middle, offsets.end());
    report.median_offset = static_cast<double>(*middle);
  }
  return report;
}

}  // namespace hulltrack
