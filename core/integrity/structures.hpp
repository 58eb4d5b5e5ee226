// Do independent parts of the ship agree on where she lies, along her and across her?
//
// The pose follows whatever surfaces fix it. A sister ship's hatch that lies 20 cm farther aft takes the pose
// along, and in sight of that hatch alone nothing contradicts; the next hatch, the house or the forecastle
// do. So what stands in place or elsewhere is counted by structures: all that belongs to one hatch is one,
// and of the rest what the map has not kApart from its neighbour in the direction that it faces. Metres, H.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/map/patches.hpp"

namespace hulltrack {

struct StructureCount {
  std::uint32_t in_place = 0;   // as most of their patches say
  std::uint32_t displaced = 0;  // likewise
};

/// The structures of one map, and what a frame's patches say about them.
class Structures {
 public:
  static constexpr float kApart = 2.0F;  // m: the steps of a deckhouse are nearer to each other

  Structures() = default;
  explicit Structures(std::span<const MapPatch> mapped);

  /// How many the map has that say where they stand in this direction: transverse along the ship,
  /// longitudinal across her.
  [[nodiscard]] std::uint32_t mapped(SurfaceClass faces) const;

  void clear_votes();
  /// That a patch is in place or displaced in the direction that it faces; none if it faces neither.
  void vote(std::uint32_t patch, bool displaced);
  [[nodiscard]] StructureCount count(SurfaceClass faces) const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Structure {
    SurfaceClass faces;
    int balance;  // patches in place less those displaced
  };
  void number(SurfaceClass faces, std::span<const MapPatch> mapped);

  std::vector<std::uint32_t> of_;  // per patch
  std::vector<Structure> structures_;
};

}  // namespace hulltrack
