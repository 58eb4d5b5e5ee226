// The list of guesses: errors of a joint, or turns of the mount, too large to show as offsets from the quay's
// planes. QuaySearch tries them in turn.
//
// - Range: travel 0.55 to 5.45 m, slew 0.7 to 3.7 deg, luff 1.2 to 5.1 deg, mount 1.2 to 3.6 deg about each
//   axis of W, to both sides.
// - Step: 0.35 m or 0.3 deg. Half a step moves a point by 0.18 m at most, on levers of 60 m (things on the
//   quay, for slew) and 40 m (its top, for luff). NearCells still finds it then, so no error lies between two
//   guesses.
// - Smaller errors show as offsets. Larger ones show otherwise: a slew passes hull.max_yaw, a luff passes
//   hull.max_heel and max_trim, and with a wrong travel rays pass through the quay's surfaces.
// Frame W; metres, radians. Pure.
#pragma once

#include <cstddef>
#include <optional>

#include "core/witness/machine_wear.hpp"

namespace hulltrack {

inline constexpr std::size_t kMachineGuesses = 134;

struct MachineGuess {
  std::optional<JointName> joint;  // nothing: the mount, turned about an axis of W
  int axis = 0;                    // of W, about which the mount is turned
  double amount = 0.0;             // that the joint reads too much, or the mount is turned, m or rad
  bool beyond_wear = false;        // wear alone cannot make the guess look right: not the first of its series
};

/// The smallest amounts of all series first, then the next ones. Precondition: number < kMachineGuesses.
[[nodiscard]] MachineGuess machine_guess(std::size_t number);

/// The sensor's error if the guess is right: a twist about the origin of W.
[[nodiscard]] Twist twist_of(const MachineGuess& guess, const MachineConfig& machine,
                             const MachineStand& stand);

}  // namespace hulltrack
