// Which errors of joints and mount are guessed at, beyond those that offsets from the quay's planes show?
//
// Each guess is met by what is off from it by half a step to both sides, 0.18 m at the levers of a boom (60 m
// for what stands on a quay, 40 m for its top): as far as NearCells reaches. What is nearer than the first is
// seen without a guess; farther off than the last, a slew is beyond hull.max_yaw, a luff beyond hull.max_heel
// and max_trim, and of a travel the quay is seen through. Frame W; metres, radians. Pure.
#pragma once

#include <cstddef>
#include <optional>

#include "core/witness/machine_wear.hpp"

namespace hulltrack {

inline constexpr std::size_t kMachineGuesses = 134;

struct MachineGuess {
  std::optional<JointName> joint;  // nothing: the mount, turned about an axis of W
  int axis = 0;                    // of the mount
  double amount = 0.0;             // m, rad
  bool beyond_wear = false;        // what wear within the class moves is not met by it, however far away
};

/// In an order in which small amounts come first. Precondition: number < kMachineGuesses.
[[nodiscard]] MachineGuess machine_guess(std::size_t number);

/// How the sensor is off if the guess is right, about the origin of W.
[[nodiscard]] Twist twist_of(const MachineGuess& guess, const MachineConfig& machine,
                             const MachineStand& stand);

}  // namespace hulltrack
