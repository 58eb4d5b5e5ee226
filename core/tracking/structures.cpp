#include "core/tracking/structures.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "core/map/relief.hpp"

namespace hulltrack {

StructureCount count_structures(std::vector<StructurePatch> patches) {
  // Hatch by hatch, then the rest by place.
  std::sort(patches.begin(), patches.end(), [](const StructurePatch& a, const StructurePatch& b) {
    return std::tie(a.pit, a.place) < std::tie(b.pit, b.place);
  });
  StructureCount count;
  for (auto first = patches.begin(); first != patches.end();) {
    int balance = 0;  // patches in place less those displaced
    auto next = first;
    do {
      balance += next->displaced ? -1 : 1;
      ++next;
    } while (next != patches.end() && next->pit == first->pit &&
             (first->pit != Relief::kNoPit || next->place - std::prev(next)->place < StructureCount::kApart));
    count.in_place += balance > 0 ? 1 : 0;
    count.displaced += balance < 0 ? 1 : 0;
    first = next;
  }
  return count;
}

}  // namespace hulltrack
