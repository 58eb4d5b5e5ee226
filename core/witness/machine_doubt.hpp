// Can wear explain how the quay lies in the scan, or does a joint, a mount or the latency read wrongly?
//
// Input: the measured misplacement of the sensor (misplacement.hpp). It is compared with all that wear within
// the class can do (machine_wear.hpp, ICD 3.1). For each joint it is estimated how much the joint reads too
// much, and how much of that wear or noise could fake (`hidden`). Of the joints that are beyond `hidden` the
// one that explains most is accused, with its amount. Even if none is accused, the machine is beyond its
// class where the mount, or the misplacement as a whole, is more than wear explains.
//
// - y: the measured offsets. w: the wear, |w_k| <= 1. G: a column g_k for each kind of wear, its twist at its
//   limit along the measured directions. y = G w + noise. S = G G^T + the covariance of the noise.
// - h: the twist of joint j for one unit, D = h . S^-1 h. The joint reads a = (h . S^-1 y) / D too much.
// - Wear alone can make a as large as sum_k |h . S^-1 g_k| / D. It hardly ever makes more than sqrt(3) times
//   the root of the sum of the squares of these terms: three sigma, if the w_k are independent and spread
//   evenly between their limits.
// - `hidden` is the smaller of these two, plus four sigma of noise.
// Frame W; metres, radians. Pure. Failure: where nothing is measured nothing is accused. Cost: a few 6 x 6
// solutions, 10 us.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "core/quay/misplacement.hpp"
#include "core/witness/machine_wear.hpp"

namespace hulltrack {

/// What one frame shows of one joint.
struct JointDoubt {
  double reads_too_much = 0.0;  // m or rad
  /// The largest amount that wear and noise could fake, m or rad; infinite where nothing is measured.
  double hidden = std::numeric_limits<double>::infinity();
  double gain = 0.0;  // fall of y . S^-1 y if this joint's error is allowed, no unit
  /// Whether guesses would find an error that is too large for offsets. Set by MachineWitness, see
  /// quay_search.hpp.
  bool finds_large = false;
};

struct MachineDoubt {
  std::array<JointDoubt, 3> joints;  // by JointName
  double strain = 0.0;               // y . S^-1 y: chi-square of the misplacement if it is all wear and noise
  double most_strain = 0.0;          // the largest strain that wear within the class explains
  std::optional<JointName> accused;
  bool mount = false;         // the LiDAR's mount alone, shifted or turned about one axis, is beyond wear
  bool beyond_class = false;  // a joint is accused, or the mount is, or the strain is too large
};

/// `of_reference`: errors that the reference (a top that the session has found) may have; twists about
/// seen.centre_W, treated as more kinds of wear.
[[nodiscard]] MachineDoubt doubt_machine(const MachineConfig& machine, const MachineStand& stand,
                                         const Misplacement& seen,
                                         const std::vector<Twist>& of_reference = {});

/// How much older the joint values are than they are taken to be; amounts in s. Measured by the change of the
/// misplacement since the machine stood (`at_rest`), and compared with what wear can change meanwhile.
/// Precondition: both misplacements hold all six directions.
[[nodiscard]] JointDoubt doubt_latency(const MachineConfig& machine, const MachineStand& stand,
                                       const Misplacement& seen, const Misplacement& at_rest);

/// How much of `twist` (about seen.centre_W) the misplacement contains, and how much of it wear could fake;
/// amounts as multiples of `twist`.
[[nodiscard]] JointDoubt doubt_twist(const MachineConfig& machine, const MachineStand& stand,
                                     const Misplacement& seen, const Twist& twist,
                                     const std::vector<Twist>& of_reference = {});

/// Why a joint is accused, in words with figures: it reads `amount` (m or rad) too much.
[[nodiscard]] std::string accusation(JointName joint, double amount);

/// Why the machine is beyond its class, in words with figures; empty if it is not.
[[nodiscard]] std::string describe(const MachineDoubt& doubt, const Misplacement& seen);

}  // namespace hulltrack
