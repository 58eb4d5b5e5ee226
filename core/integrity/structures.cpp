#include "core/integrity/structures.hpp"

#include <algorithm>
#include <tuple>

namespace hulltrack {

Structures::Structures(std::span<const Landmark> mapped) : of_(mapped.size(), kNone) {
  number(SurfaceClass::transverse, mapped);
  number(SurfaceClass::longitudinal, mapped);
}

void Structures::number(SurfaceClass faces, std::span<const Landmark> mapped) {
  std::vector<std::uint32_t> facing;
  for (std::uint32_t i = 0; i < mapped.size(); ++i) {
    if (mapped[i].faces == faces) {
      facing.push_back(i);
    }
  }
  // Hatch by hatch, then the rest by place.
  std::sort(facing.begin(), facing.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(mapped[a].hold, mapped[a].place) < std::tie(mapped[b].hold, mapped[b].place);
  });
  const Landmark* last = nullptr;
  for (const std::uint32_t i : facing) {
    const Landmark& landmark = mapped[i];
    const bool goes_on = last != nullptr && landmark.hold == last->hold &&
                         (landmark.hold != Relief::kNoHold || landmark.place - last->place < kApart);
    if (!goes_on) {
      structures_.push_back({faces, 0});
    }
    of_[i] = static_cast<std::uint32_t>(structures_.size() - 1);
    last = &landmark;
  }
}

std::uint32_t Structures::mapped(SurfaceClass faces) const {
  return static_cast<std::uint32_t>(
      std::count_if(structures_.begin(), structures_.end(),
                    [&](const Structure& structure) { return structure.faces == faces; }));
}

void Structures::clear_votes() {
  for (Structure& structure : structures_) {
    structure.balance = 0;
  }
}

void Structures::vote(std::uint32_t landmark, bool displaced) {
  if (of_[landmark] != kNone) {
    structures_[of_[landmark]].balance += displaced ? -1 : 1;
  }
}

StructureCount Structures::count(SurfaceClass faces) const {
  StructureCount count;
  for (const Structure& structure : structures_) {
    if (structure.faces == faces) {
      count.in_place += structure.balance > 0 ? 1 : 0;
      count.displaced += structure.balance < 0 ? 1 : 0;
    }
  }
  return count;
}

}  // namespace hulltrack
