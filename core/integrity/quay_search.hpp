// Is more of the quay met where another value of one joint would put the machine?
//
// What a return is farther off than QuayMap::kGate belongs to something else. So a joint that is off by a
// metre finds little near the planes of the map that it moves: nothing, or by chance a wall that looks like
// another. One guess a frame is tried in its stead: were this joint off by that much, which of the scan's
// returns would lie on planes? A guess is better when the returns of one class of surfaces that it explains
// are many, spread farther than anything that can be moved is long, and a multiple of those that are
// explained where the machine is said to be, and no other class loses by it. A guess that was better is tried
// again in the next frame, else it is the next one's turn; a round takes two seconds.
// Frame W; metres, radians. Thread rule: one owner. Cost: 0.1 ms a frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/integrity/machine_wear.hpp"
#include "core/integrity/misplacement.hpp"
#include "core/integrity/quay_sight.hpp"

namespace hulltrack {

class QuaySearch {
 public:
  /// What leaves the quay in one piece is a lorry or a row of containers, 20 m long at most: what is spread
  /// farther than this does not move. m
  static constexpr float kLongestThing = 25.0F;

  /// `has_region`: as of QuaySight.
  explicit QuaySearch(bool has_region);

  /// Of each class, how many of the returns that are asked lie on planes.
  using Met = std::array<double, QuayMap::kClasses>;
  /// Where the machine is said to be; `seen` is what the observations came to.
  [[nodiscard]] static Met met(const QuaySighting& sighting, const Misplacement& seen);

  /// Whether an error of the joint that is too large for `seen` to show it would be found: enough is met, far
  /// enough apart, of what such an error moves.
  [[nodiscard]] static bool would_find(JointName joint, const QuaySighting& sighting,
                                       const Misplacement& seen, const MachineConfig& machine,
                                       const MachineStand& stand);

  /// One guess; where the quay then lies if it is better. `in_place`: of this frame.
  [[nodiscard]] std::optional<Misplacement> look(const QuayMap& map, const FilteredScan& scan,
                                                 const MachineConfig& machine, const MachineStand& stand,
                                                 const Met& in_place);

  /// Where the quay lies if more of it is met were the joint off by `amount` (m, rad).
  [[nodiscard]] std::optional<Misplacement> look_there(const QuayMap& map, const FilteredScan& scan,
                                                       const MachineConfig& machine,
                                                       const MachineStand& stand, const Met& in_place,
                                                       JointName joint, double amount);

  /// Begins with the first guess again.
  void forget() { guess_ = 0; }

 private:
  struct Sight {
    Misplacement seen;  // about where the machine is said to be
    Met met{};
    std::array<float, QuayMap::kClasses> extent{};  // of what is met, m
  };
  [[nodiscard]] Sight sight_of(const QuayMap& map, const FilteredScan& scan, const MachineConfig& machine,
                               const MachineStand& stand, JointName joint, double amount);

  QuaySight sight_;
  std::size_t guess_ = 0;
};

}  // namespace hulltrack
