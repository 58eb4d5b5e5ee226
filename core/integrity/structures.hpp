// Do independent parts of the ship agree on where she lies, along her and across her?
//
// Input: votes of the map's landmarks (flat pieces, see core/map/landmarks.hpp): in place or displaced.
// Output: how many structures are in place, and how many displaced, in each of the two directions. A
// structure is one voice: all landmarks of one hatch, or neighbours outside of hatches that are less than
// kApart from each other in the direction that they face.
// Reason: the pose follows whatever surfaces fix it. If a sister ship's hatch lies 20 cm farther aft, the
// pose moves with it, and nothing contradicts while that hatch alone is in sight. The next hatch, the house
// or the forecastle does. Metres, H.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/map/landmarks.hpp"

namespace hulltrack {

struct StructureCount {
  std::uint32_t in_place = 0;   // more of their landmarks are in place than displaced
  std::uint32_t displaced = 0;  // more are displaced; a tie is counted nowhere
};

/// The structures of one map, and what a frame's landmarks say about them.
class Structures {
 public:
  static constexpr float kApart = 2.0F;  // m: the steps of a deckhouse are nearer to each other

  Structures() = default;
  explicit Structures(std::span<const Landmark> mapped);

  /// How many structures of the map face this way. Transverse ones tell the place along the ship,
  /// longitudinal ones the place across her.
  [[nodiscard]] std::uint32_t mapped(SurfaceClass faces) const;

  void clear_votes();
  /// A landmark is in place or displaced in the direction that it faces. Ignored if that is neither of the
  /// two.
  void vote(std::uint32_t landmark, bool displaced);
  [[nodiscard]] StructureCount count(SurfaceClass faces) const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Structure {
    SurfaceClass faces;
    int balance;  // landmarks in place less those displaced
  };
  void number(SurfaceClass faces, std::span<const Landmark> mapped);

  std::vector<std::uint32_t> of_;  // per landmark: its structure's index, or kNone
  std::vector<Structure> structures_;
};

}  // namespace hulltrack
