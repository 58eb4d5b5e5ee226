#include "core/integrity/landmark_memory.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hulltrack {
namespace {

// A landmark is judged on the last kMemory returns: with 3 cm of noise their median is good to 0.3 cm.
constexpr float kMemory = 200.0F;
// With fewer returns it is not judged. The sigma of 12 is 1.25 * 3 cm / sqrt(12) = 1.1 cm, 1/4 of kDisplaced.
constexpr double kFewest = 12.0;
// Median offset up to which a landmark is in place. It allows for three sigma of that noise (3.3 cm), the
// bend that a pose does not take out (parabola of L/1000 of a ship of 120 m: 1 cm in 25 m), the map's 0.5 cm.
constexpr double kDisplaced = 0.045;  // m
// Offset behind a wall from which on it is set back, about five sigma, since one such wall is enough: 1.1 cm
// of noise and 1.5 cm of the pose (the largest that is used, kBlurred in integrity.cpp) are 1.9 cm.
constexpr double kSetBack = 0.1;         // m
constexpr double kCoherent = 0.075;      // m from the median: 2.5 sigma of a return
constexpr double kLeastCoherence = 0.8;  // share so near: one surface has 0.99; a fifth may meet other things
// Share of the rays that go through; above it the landmark is gone. Of one in its place at most 0.11 go
// through (130,000 judgements in seven recordings of a berth: VLP-16 with draft, shift, rain and moved
// covers, two VLP-16, XT-32), of a rim that stands 0.3 m aside all: no judgement lay between 0.3 and 0.5.
constexpr double kMostThrough = 0.4;
// Share of the looks beside a rim; above it a cover lies on the rim. Without one less than 0.01 go on (17,000
// judgements there); with one nearly all should, which no recording has shown yet.
constexpr double kMostGoesOn = 0.25;

// `decided` needs so many frames that showed landmarks, so many judged landmarks and this share of those in
// view. One frame of 16 lines leaves landmarks out; the loader's motion and the noise show them in the next
// frames. After five frames 80 to 86 % of those in view were judged there, after nine 91 to 98 %; a quarter
// may stay hidden or lie at the edge of the view. 45 to 87 were judged by then: eight is a floor for views of
// one corner of a hatch, of which the structures (has_seen_enough()) ask more.
constexpr std::uint32_t kFramesToDecide = 9;
constexpr std::uint32_t kFewestToDecide = 8;
constexpr double kShareToDecide = 0.75;
constexpr std::uint32_t kFewestStructures = 2;  // in place along the ship

using Offsets = std::array<float, LandmarkMemory::kBins>;
constexpr double kBin = 2.0 * LandmarkMemory::kReach / LandmarkMemory::kBins;  // m

double median_offset(const Offsets& offsets, double total) {
  double below = 0.0;
  std::size_t middle = 0;
  while (below + static_cast<double>(offsets[middle]) < 0.5 * total) {
    below += static_cast<double>(offsets[middle++]);
  }
  const double share = (0.5 * total - below) / static_cast<double>(offsets[middle]);
  return (static_cast<double>(middle) + share) * kBin - LandmarkMemory::kReach;
}

/// Sum of the bins whose middle lies between `low` and `high`, m.
double sum_between(const Offsets& offsets, double low, double high) {
  double sum = 0.0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * kBin - LandmarkMemory::kReach;
    sum += middle >= low && middle <= high ? static_cast<double>(offsets[i]) : 0.0;
  }
  return sum;
}

}  // namespace

void LandmarkMemory::reset(std::vector<Landmark> mapped) {
  histograms_.assign(mapped.size(), {});
  verdicts_.assign(mapped.size(), {});
  mapped_ = std::move(mapped);
  structures_ = Structures(mapped_);
  has_rims_ = std::any_of(mapped_.begin(), mapped_.end(),
                          [](const Landmark& landmark) { return landmark.kind == LandmarkKind::rim; });
  rims_.clear();
  frame_ = 0;
  frames_ = 0;
  jumps_H_.setZero();
  decided_ = false;
}

void LandmarkMemory::put_elsewhere(const Point& jump_H) {
  jumps_H_ += jump_H;
  rims_.clear();
  for (Histogram& histogram : histograms_) {
    histogram = {.last_frame = histogram.last_frame};
  }
}

LandmarkMemory::Histogram& LandmarkMemory::touch(std::uint32_t landmark) {
  Histogram& p = histograms_[landmark];
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

void LandmarkMemory::add_offset(std::uint32_t landmark, double offset, double returns) {
  const int bin = static_cast<int>((offset + kReach) / (2.0 * kReach) * kBins);
  touch(landmark).offsets[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))] +=
      static_cast<float>(returns);
}

void LandmarkMemory::add_through(std::uint32_t landmark) { touch(landmark).through += 1.0F; }

void LandmarkMemory::add_beside(std::uint32_t landmark, bool goes_on) {
  Histogram& p = touch(landmark);
  (goes_on ? p.goes_on : p.ends) += 1.0F;
}

void LandmarkMemory::add_across(const RimPoint& rim, float s, bool on) {
  Rim& seen = rims_[rim.landmark];
  if (seen.last_frame != frame_) {
    seen.last_frame = frame_;
    seen.begin = rim.begin;
    seen.end = rim.end;
    seen.rays.begin_frame();
  }
  seen.rays.add(s, on);
}

RimMemory::Finding LandmarkMemory::judge_rim(std::uint32_t landmark) const {
  const auto found = rims_.find(landmark);
  return found == rims_.end() ? RimMemory::Finding{}
                              : found->second.rays.judge(found->second.begin, found->second.end);
}

LandmarkFinding LandmarkMemory::judge(std::uint32_t landmark) const {
  const Histogram& p = histograms_[landmark];
  const bool is_wall = mapped_[landmark].kind == LandmarkKind::coaming_wall;
  LandmarkFinding finding;
  const double on = std::accumulate(p.offsets.begin(), p.offsets.end(), 0.0);
  const auto through = static_cast<double>(p.through);
  finding.returns = on + through;
  if (finding.returns < kFewest) {
    return finding;
  }
  if (on > 0.0) {
    finding.offset = median_offset(p.offsets, on);
    finding.coherence =
        sum_between(p.offsets, finding.offset - kCoherent, finding.offset + kCoherent) / finding.returns;
  }
  if (is_wall && through + sum_between(p.offsets, -kReach, -kSetBack) > 0.5 * finding.returns) {
    finding.state = LandmarkState::set_back;
  } else if (!is_wall && through > kMostThrough * finding.returns) {
    finding.state = LandmarkState::gone;
  } else if (finding.coherence < kLeastCoherence) {
    finding.state = LandmarkState::scattered;
  } else if (std::abs(finding.offset) <= kDisplaced) {
    finding.state = LandmarkState::in_place;
  } else if (finding.offset > 0.0 && p.goes_on > kMostGoesOn * (p.goes_on + p.ends)) {
    finding.state = LandmarkState::covered;
  } else {
    finding.state = LandmarkState::displaced;
  }
  return finding;
}

void LandmarkMemory::judge_again(std::uint32_t landmark) {
  judge_rim_again(landmark);
  Verdict& verdict = verdicts_[landmark];
  const LandmarkFinding plane = judge(landmark);
  if (plane.state == LandmarkState::unknown) {
    return;  // too few returns: the earlier verdict stands
  }
  verdict.jumps_H = jumps_H_;
  verdict.state = plane.state;
  if (plane.state == LandmarkState::displaced || plane.state == LandmarkState::set_back) {
    verdict.off_plane = true;
    verdict.set_back = verdict.set_back || plane.state == LandmarkState::set_back;
    verdict.by = static_cast<float>(std::abs(plane.offset));
  } else if (plane.state == LandmarkState::gone && mapped_[landmark].kind == LandmarkKind::rim) {
    verdict.off_plane = true;
    verdict.by = 0.0F;
  } else if (plane.state != LandmarkState::scattered) {
    verdict.off_plane = false;
    verdict.set_back = false;
  }
}

void LandmarkMemory::judge_rim_again(std::uint32_t landmark) {
  Verdict& verdict = verdicts_[landmark];
  const RimMemory::Finding rim = judge_rim(landmark);
  if (!rim.displaced() && !rim.in_place()) {
    return;
  }
  verdict.rim_jumps_H = jumps_H_;
  verdict.aside = rim.displaced();
  verdict.in_line = !verdict.aside;
  if (verdict.aside) {
    verdict.by = static_cast<float>(std::abs(rim.shift));
  }
}

/// Votes for the landmark's structure in the direction that it faces: a rim by its place across its length,
/// another landmark by its offset. A jump of the pose by more than kDisplaced that way since makes it
/// displaced.
void LandmarkMemory::vote(std::uint32_t landmark) {
  const Landmark& mapped = mapped_[landmark];
  const Verdict& verdict = verdicts_[landmark];
  const bool is_rim = mapped.kind == LandmarkKind::rim;
  const bool displaced = is_rim ? verdict.aside : verdict.off_plane;
  const bool in_place = is_rim ? verdict.in_line : verdict.state == LandmarkState::in_place;
  if (mapped.faces != SurfaceClass::other && (displaced || in_place)) {
    const Point& jumps_H = is_rim ? verdict.rim_jumps_H : verdict.jumps_H;
    const float since = (jumps_H_ - jumps_H)[static_cast<Eigen::Index>(mapped.faces)];
    structures_.vote(landmark, displaced || std::abs(since) > kDisplaced);
  }
}

/// Besides enough frames and landmarks: two structures in place along the ship, where hatches differ, if the
/// map has two. The pose moves with a single one wherever it stands; with none, movable things may hold it.
/// And a rim in place, if the map has rims: the hatches are as high above the deck as the map's.
bool LandmarkMemory::has_seen_enough(const LandmarkReport& report) const {
  return frames_ >= kFramesToDecide && report.judged >= kFewestToDecide &&
         report.judged >= kShareToDecide * report.in_view && (report.rims_in_place > 0 || !has_rims_) &&
         report.along.in_place >= std::min(kFewestStructures, structures_.mapped(SurfaceClass::transverse));
}

LandmarkReport LandmarkMemory::report() {
  LandmarkReport report;
  std::vector<float> offsets;
  structures_.clear_votes();
  for (std::uint32_t i = 0; i < size(); ++i) {
    const Verdict& verdict = verdicts_[i];
    if (histograms_[i].last_frame == frame_) {
      judge_again(i);
      ++report.in_view;
      report.judged += verdict.state == LandmarkState::unknown ? 0 : 1;
    }
    vote(i);
    const bool is_rim = mapped_[i].kind == LandmarkKind::rim;
    const bool elsewhere = verdict.off_plane || verdict.aside;
    if (elsewhere) {
      ++report.displaced;
      report.displaced_rims += is_rim ? 1 : 0;
      report.set_back += verdict.set_back ? 1 : 0;
      if (verdict.by > 0.0F) {
        offsets.push_back(verdict.by);
      }
    }
    const bool same_height = std::abs((jumps_H_ - verdict.jumps_H).z()) <= static_cast<float>(kDisplaced);
    report.rims_in_place += is_rim && verdict.state == LandmarkState::in_place && same_height ? 1 : 0;
    report.solid += elsewhere || verdict.state == LandmarkState::in_place ? 1 : 0;
  }
  frames_ += report.in_view > 0 ? 1 : 0;
  report.along = structures_.count(SurfaceClass::transverse);
  report.across = structures_.count(SurfaceClass::longitudinal);
  decided_ = decided_ || has_seen_enough(report);
  report.decided = decided_;
  if (!offsets.empty()) {
    const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
    std::nth_element(offsets.begin(), middle, offsets.end());
    report.median_offset = static_cast<double>(*middle);
  }
  return report;
}

}  // namespace hulltrack
