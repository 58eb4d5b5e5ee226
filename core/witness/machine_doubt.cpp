#include "core/witness/machine_doubt.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

constexpr double kNoiseSigmas = 4.0;
const double kSpread = std::sqrt(3.0);  // three sigma of what is spread evenly between -1 and 1

/// Components of twists along the measured directions: one column for each twist.
Eigen::MatrixXd along(const Misplacement& seen, const std::vector<Twist>& twists) {
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(seen.measured.size()),
                          static_cast<Eigen::Index>(twists.size()));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
      columns(i, k) =
          seen.measured[static_cast<std::size_t>(i)].direction.dot(twists[static_cast<std::size_t>(k)]);
    }
  }
  return columns;
}

/// Measured offsets y, and wear and noise to compare them with: y = G w + noise (see machine_doubt.hpp).
struct Weighing {
  Eigen::VectorXd y, noise;
  Eigen::MatrixXd G, S_inverse;

  Weighing(Eigen::VectorXd seen, Eigen::VectorXd sigmas, Eigen::MatrixXd wear)
      : y(std::move(seen)), noise(std::move(sigmas)), G(std::move(wear)) {
    Eigen::MatrixXd S = G * G.transpose();
    S.diagonal() += noise.cwiseAbs2();
    S_inverse = S.ldlt().solve(Eigen::MatrixXd::Identity(y.size(), y.size()));
  }

  /// How much of `h` is in y, how much of it wear and noise can fake, and the gain.
  [[nodiscard]] JointDoubt doubt_along(const Eigen::VectorXd& h) const {
    const Eigen::VectorXd weights = S_inverse * h;
    const double information = h.dot(weights);
    if (!(information > 0.0)) {
      return {};
    }
    const Eigen::VectorXd wear = (G.transpose() * weights).cwiseAbs();
    const double most_of_wear = std::min(wear.sum(), kSpread * wear.norm());
    const double most_of_noise = kNoiseSigmas * weights.cwiseProduct(noise).norm();
    const double z = weights.dot(y);
    return {z / information, (most_of_wear + most_of_noise) / information, z * z / information};
  }
};

/// Of all measured directions, with wear and the reference's errors. Precondition: something is measured.
Weighing weigh(const MachineConfig& machine, const MachineStand& stand, const Misplacement& seen,
               const std::vector<Twist>& of_reference) {
  const auto n = static_cast<Eigen::Index>(seen.measured.size());
  Eigen::VectorXd y(n);
  Eigen::VectorXd noise(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    y[i] = seen.measured[static_cast<std::size_t>(i)].offset;
    noise[i] = seen.measured[static_cast<std::size_t>(i)].sigma;
  }
  std::vector<Twist> twists = wear_twists(machine, stand, seen.centre_W);
  twists.insert(twists.end(), of_reference.begin(), of_reference.end());
  return {std::move(y), std::move(noise), along(seen, twists)};
}

/// A joint is not accused where wear could hide more of it than this: it then hardly moves what is seen, and
/// metres of it would stand for a small offset. So it is with travel where only a top that slopes a little is
/// seen. The strain is checked all the same.
double most_hidden(JointName joint) { return joint == JointName::travel ? 2.0 : radians(5.0); }  // m, rad
constexpr std::array<double, 6> kMostHiddenOfMount = {1.0, 1.0, 1.0, 0.1, 0.1, 0.1};             // m, rad

}  // namespace

MachineDoubt doubt_machine(const MachineConfig& machine, const MachineStand& stand, const Misplacement& seen,
                           const std::vector<Twist>& of_reference) {
  MachineDoubt doubt;
  if (seen.measured.empty()) {
    return doubt;
  }
  const Weighing weighing = weigh(machine, stand, seen, of_reference);
  double best = 0.0;
  for (const JointName joint : kAllJoints) {
    const Eigen::VectorXd h = along(seen, {joint_twist(machine, stand, joint, seen.centre_W)});
    JointDoubt& here = doubt.joints.at(static_cast<std::size_t>(joint));
    here = weighing.doubt_along(h);
    if (here.hidden <= most_hidden(joint) && std::abs(here.reads_too_much) > here.hidden &&
        here.gain > best) {
      best = here.gain;
      doubt.accused = joint;
    }
  }
  const std::array<Twist, 6> of_mount = mount_twists(stand, seen.centre_W);
  for (std::size_t i = 0; i < of_mount.size(); ++i) {
    const JointDoubt mount = weighing.doubt_along(along(seen, {of_mount[i]}));
    doubt.mount = doubt.mount ||
                  (mount.hidden <= kMostHiddenOfMount[i] && std::abs(mount.reads_too_much) > mount.hidden);
  }
  doubt.strain = weighing.y.dot(weighing.S_inverse * weighing.y);
  // The strain of wear at its limits is at most the number of kinds of wear. Wear that is spread evenly
  // between them has a mean square of 1/3 in each direction; nine times that, three sigma, is 3 a direction.
  doubt.most_strain =
      std::min(static_cast<double>(weighing.G.cols()), 3.0 * static_cast<double>(weighing.y.size()));
  doubt.beyond_class = doubt.accused || doubt.mount || doubt.strain > doubt.most_strain;
  return doubt;
}

JointDoubt doubt_twist(const MachineConfig& machine, const MachineStand& stand, const Misplacement& seen,
                       const Twist& twist, const std::vector<Twist>& of_reference) {
  return seen.measured.empty() ? JointDoubt{}
                               : weigh(machine, stand, seen, of_reference).doubt_along(along(seen, {twist}));
}

JointDoubt doubt_latency(const MachineConfig& machine, const MachineStand& stand, const Misplacement& seen,
                         const Misplacement& at_rest) {
  const auto n = static_cast<Eigen::Index>(seen.measured.size());
  const Twist since = seen.twist - at_rest.about(seen.centre_W);
  double rest_sigma = 0.0;  // of the worst direction at rest: the two have different directions
  for (const Misplacement::Measurement& measured : at_rest.measured) {
    rest_sigma = std::max(rest_sigma, measured.sigma);
  }
  Eigen::VectorXd y(n);
  Eigen::VectorXd noise(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Misplacement::Measurement& measured = seen.measured[static_cast<std::size_t>(i)];
    y[i] = measured.direction.dot(since);
    noise[i] = std::hypot(measured.sigma, rest_sigma);
  }
  return Weighing(std::move(y), std::move(noise),
                  along(seen, fast_wear_twists(machine, stand, seen.centre_W)))
      .doubt_along(along(seen, {lateness_twist(machine, stand, seen.centre_W)}));
}

std::string accusation(JointName joint, double amount) {
  const bool turns = joint != JointName::travel;
  return format_text(
      "the quay lies as if %s read %.2f %s too %s: its sign, scale, bias or latency, or an encoder "
      "that stands still?",
      joint_name(joint), std::abs(turns ? degrees(amount) : amount), turns ? "deg" : "m",
      amount > 0.0 ? "much" : "little");
}

std::string describe(const MachineDoubt& doubt, const Misplacement& seen) {
  if (!doubt.beyond_class) {
    return {};
  }
  if (doubt.accused) {
    return accusation(*doubt.accused,
                      doubt.joints.at(static_cast<std::size_t>(*doubt.accused)).reads_too_much);
  }
  const Eigen::Vector3d turn = seen.twist.head<3>() * degrees(1.0);
  const Eigen::Vector3d shift = seen.twist.tail<3>();
  return format_text(
      "the quay lies %.2f, %.2f, %.2f m and %.2f, %.2f, %.2f deg from where joints and mount put "
      "it: a mount, or several joints, are not what is configured",
      shift.x(), shift.y(), shift.z(), turn.x(), turn.y(), turn.z());
}

}  // namespace hulltrack
