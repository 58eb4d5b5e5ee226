// Is the machine where its encoders say? The quay's verdict on joints, mounts and latency.
//
// The misplacement that a scan shows (misplacement.hpp) is held against all that wear within the class can do
// (machine_wear.hpp). One joint that reads something else than it should explains it better than any wear
// can: that joint is accused, with the amount. Or nothing within the class explains it: then the machine is.
//
// With w the wear in units of its class, |w_k| <= 1, and G its twists along the measured directions, the
// offsets are y = G w + noise. S = G G^T + noise weighs them. What joint j reads too much is estimated as a =
// (h . S^-1 y) / (h . S^-1 h), h its twist; wear alone lets this be as large as sum_k |h . S^-1 g_k|, and,
// its terms being independent, hardly ever more than sqrt(3) times the root of the sum of their squares
// (three sigma of terms spread evenly between their limits). Beyond the smaller of the two, and four sigma of
// noise, the joint is accused. Frame W; metres, radians. Pure. Cost: a few 6 x 6 solutions, 10 us.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "core/quay/misplacement.hpp"
#include "core/witness/machine_wear.hpp"

namespace hulltrack {

/// What wear within the class hides of one joint, and what was found.
struct JointDoubt {
  double reads_too_much = 0.0;  // m, rad
  /// Up to here it may be wear, m, rad; infinite where nothing is measured.
  double hidden = std::numeric_limits<double>::infinity();
  double gain = 0.0;  // how much better than wear it explains what is seen, in units of S
  /// Whether an error that is too large to be seen as such would be found (quay_search.hpp).
  bool finds_large = false;
};

struct MachineDoubt {
  std::array<JointDoubt, 3> joints;  // by JointName
  double strain = 0.0;               // y . S^-1 y, the wear that would be needed, squared and summed
  double most_strain = 0.0;          // what wear within the class can come to
  std::optional<JointName> accused;
  bool mount = false;         // the LiDAR's mount alone, shifted or turned about one axis, is beyond wear
  bool beyond_class = false;  // a joint is accused, or the mount is, or the strain is too large
};

/// `of_reference`: twists about seen.centre_W, as wear's, by which what the quay is held against may be
/// wrong.
[[nodiscard]] MachineDoubt doubt_machine(const MachineConfig& machine, const MachineStand& stand,
                                         const Misplacement& seen,
                                         const std::vector<Twist>& of_reference = {});

/// The same of joint values that are older than they are taken to be: what of the misplacement has come since
/// the machine stood (`at_rest`), held against what wear can change meanwhile. Both hold all six directions.
/// Amounts in s.
[[nodiscard]] JointDoubt doubt_latency(const MachineConfig& machine, const MachineStand& stand,
                                       const Misplacement& seen, const Misplacement& at_rest);

/// How much there is of a twist about seen.centre_W, and how much of it wear within the class hides, in units
/// of that twist.
[[nodiscard]] JointDoubt doubt_twist(const MachineConfig& machine, const MachineStand& stand,
                                     const Misplacement& seen, const Twist& twist,
                                     const std::vector<Twist>& of_reference = {});

/// In words with figures, why a joint is accused: it reads `amount` (m, rad) too much.
[[nodiscard]] std::string accusation(JointName joint, double amount);

/// In words with figures; empty without doubt.
[[nodiscard]] std::string describe(const MachineDoubt& doubt, const Misplacement& seen);

}  // namespace hulltrack
