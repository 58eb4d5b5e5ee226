#include "core/integrity/rim_memory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hulltrack {
namespace {

// Rays that are remembered. A tenth of 400 lies within 3 cm of an edge, enough to place it to 1 cm.
constexpr float kMemory = 400.0F;
constexpr float kFewest = 25.0F;  // rays of each kind; with fewer nothing is known
// A rim is in place up to this shift, displaced beyond it. Errors that it allows for: an edge is seen by a
// beam 3 to 5 cm wide, its mean is good to 1 cm; the pose's error is taken off to 2 cm where the surfaces
// that hold the pose are the hatches' own; the map's edges are known to half of its 5 cm voxel.
constexpr double kDisplaced = 0.06;  // m
// A displaced rim needs a shift that explains more contradicting rays than kFewestExplained, five sigma of
// a count of 25, and a larger share of them than kLeastExplained: the rim has to be whole at its new place.
constexpr double kFewestExplained = 25.0;
constexpr double kLeastExplained = 0.7;
constexpr float kFarthest = 0.35F;  // m: largest shift tried; farther aside another rim may be meant

}  // namespace

bool RimMemory::Finding::displaced() const {
  return known && std::abs(shift) > kDisplaced && explained > kFewestExplained &&
         explained > kLeastExplained * against;
}

bool RimMemory::Finding::in_place() const { return known && std::abs(shift) <= kDisplaced; }

void RimMemory::begin_frame() {
  const float total =
      std::accumulate(on_.begin(), on_.end(), 0.0F) + std::accumulate(through_.begin(), through_.end(), 0.0F);
  if (total > kMemory) {
    const float keep = kMemory / total;
    for (std::size_t i = 0; i < on_.size(); ++i) {
      on_[i] *= keep;
      through_[i] *= keep;
    }
  }
}

void RimMemory::add(float s, bool on) {
  const int bin = static_cast<int>(std::floor((s + kAside) / kBin));
  if (bin >= 0 && bin < kBins) {
    (on ? on_ : through_)[static_cast<std::size_t>(bin)] += 1.0F;
  }
}

RimMemory::Finding RimMemory::judge(float begin, float end) const {
  Finding finding;
  const float on = std::accumulate(on_.begin(), on_.end(), 0.0F);
  const float through = std::accumulate(through_.begin(), through_.end(), 0.0F);
  if (on < kFewest || through < kFewest) {
    return finding;
  }
  // balance[i]: rays through minus rays on in the first i bins, so that any shift takes one subtraction.
  std::array<float, kBins + 1> balance{};
  for (std::size_t i = 0; i < kBins; ++i) {
    balance[i + 1] = balance[i] + through_[i] - on_[i];
  }
  const auto bin = [](float s) { return static_cast<int>(std::lround((s + kAside) / kBin)); };
  const auto against = [&](int shift) {
    const auto low = static_cast<std::size_t>(std::clamp(bin(begin) + shift, 0, kBins));
    const auto high = static_cast<std::size_t>(std::clamp(bin(end) + shift, 0, kBins));
    return on + balance[high] - balance[low];
  };
  float least = std::numeric_limits<float>::max();
  int first = 0;  // of the equally good best shifts
  int last = 0;
  const int reach = static_cast<int>(kFarthest / kBin);
  for (int shift = -reach; shift <= reach; ++shift) {
    const float contradictions = against(shift);
    if (contradictions < least - 0.5F) {
      least = contradictions;
      first = shift;
    }
    if (contradictions < least + 0.5F) {
      last = shift;
    }
  }
  finding.known = true;
  finding.shift = 0.5 * static_cast<double>(first + last) * static_cast<double>(kBin);
  finding.against = static_cast<double>(against(0));
  finding.explained = finding.against - static_cast<double>(least);
  return finding;
}

}  // namespace hulltrack
