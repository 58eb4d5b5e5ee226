// Does a frame show that what the machine is charged with is gone?
//
// Only if what is seen, and all of what wear may take away from it, are together less than the charge: that
// wear could explain as much where the machine stands now refutes nothing. Frame W; metres, radians. Pure.
#pragma once

#include <functional>
#include <vector>

#include "core/witness/machine_charges.hpp"
#include "core/witness/machine_doubt.hpp"

namespace hulltrack {

/// What a frame sees of the machine. Everything outlives the call.
struct MachineSight {
  const MachineConfig& machine;
  const MachineStand& stand;
  const Misplacement& seen;
};

/// `left`: what is seen, in the unit of `charged`.
[[nodiscard]] bool refutes(const JointDoubt& left, double charged = 1.0);

/// Late values. Only while the joints that moved when it was charged move again. `at_rest`: what was seen
/// when the machine stood. Preconditions: both sights hold all six directions, and all observations of
/// `sight` are of one speed: older ones would be held against a speed that was not theirs.
[[nodiscard]] bool refutes(const WrongLatency& charged, const MachineSight& sight,
                           const Misplacement& at_rest);

/// A wrong place. What is wrong may be carried by the boom, as a mount is, or stay as it is in W, as a wrong
/// travel does: both have to be refuted. What was not seen of it may be anything. `of_reference`: errors that
/// the reference may have. If the place is too large to show as offsets, things that cannot have left have to
/// be missed there, too: `misses` says so of the sensor's error as a twist about the origin of W.
[[nodiscard]] bool refutes(const WrongPlace& charged, const MachineSight& sight,
                           const std::vector<Twist>& of_reference,
                           const std::function<bool(const Twist& off)>& misses);

}  // namespace hulltrack
