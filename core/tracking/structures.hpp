// Do independent parts of the ship agree on where she lies, along her and across her?
//
// The pose follows whatever surfaces fix it. A sister ship's hatch that lies 20 cm farther aft takes the pose
// along, and in sight of that hatch alone nothing contradicts; the next hatch, the house or the forecastle
// do. So what stands in place or elsewhere is counted by structures: all that belongs to one hatch is one,
// and of the rest what is not kApart from its neighbour in the direction asked for. Pure function; metres, H.
#pragma once

#include <cstdint>
#include <vector>

namespace hulltrack {

/// A patch that says where its structure stands in one level direction.
struct StructurePatch {
  std::uint32_t pit;  // number of its hatch; Relief::kNoPit: of none
  float place;        // m, in the direction
  bool displaced;
};

struct StructureCount {
  static constexpr float kApart = 2.0F;  // m: the steps of a deckhouse are nearer to each other
  std::uint32_t in_place = 0;            // as most of their patches say
  std::uint32_t displaced = 0;           // likewise
};

[[nodiscard]] StructureCount count_structures(std::vector<StructurePatch> patches);

}  // namespace hulltrack
