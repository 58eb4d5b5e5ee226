#include "core/witness/joint_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

// A move that is shorter says little of a joint.
const Eigen::Vector3d kShortest(0.5, radians(2.0), radians(1.0));
// A pose settles this long after the machine.
constexpr Nanoseconds kSettles = std::chrono::milliseconds(300);
constexpr Nanoseconds kLongest = std::chrono::seconds(10);
constexpr Nanoseconds kGap = std::chrono::milliseconds(500);

// What a moored ship does by herself within ten seconds, 1 sigma: rolls and pitches with the waves, ranges at
// her lines with half a period of 15 s and more; rotation, then translation.
const Twist kOwnMotion = (Twist() << radians(0.3), radians(0.1), radians(0.1), 0.15, 0.10, 0.05).finished();
// As many moves as this are what that is worth when a scatter is estimated.
constexpr double kPriorMoves = 10.0;

// Student's t that one machine in a million reaches by chance, two-sided, with the 13 degrees of freedom of
// four moves and the prior; more moves have smaller ones.
constexpr double kBeyondChance = 8.7;
// Below this it is an encoder's drift within its class over a short move: 0.05 deg of 2.5 deg.
constexpr double kLeast = 0.02;

Eigen::Vector3d values(const Joints& joints) { return {joints.d_x, joints.theta_r, joints.theta_p}; }

}  // namespace

void JointMotionWitness::add(MeasurementTime time, const MachineStand& stand,
                             const Eigen::Vector3d& reference_W, const Eigen::Matrix3d& R_W_H) {
  const Moment now{time, stand.joints, reference_W, R_W_H};
  if (!last_ || time <= last_->time || time - last_->time > kGap) {
    last_ = now;
    move_.reset();
    return;
  }
  const Eigen::Vector3d step = values(now.joints) - values(last_->joints);
  const double dt = to_seconds(time - last_->time);
  const bool moving = (step.cwiseAbs().array() > dt * kStandsBelow.array()).any();
  if (moving && !move_) {
    move_ = Move{.begin = *last_, .last_moving = time};
  }
  last_ = now;
  if (!move_) {
    return;
  }
  for (const JointName joint : kAllJoints) {
    const auto j = static_cast<Eigen::Index>(joint);
    move_->X.col(j) += step[j] * joint_twist(machine_, stand, joint, reference_W);
  }
  move_->travelled += step;
  move_->last_moving = moving ? time : move_->last_moving;
  if (time - move_->last_moving >= kSettles || time - move_->begin.time >= kLongest) {
    finish(*move_, now);
    move_.reset();
  }
}

void JointMotionWitness::finish(const Move& move, const Moment& end) {
  Twist y;
  y << so3_log(end.R_W_H * move.begin.R_W_H.transpose()), end.reference_W - move.begin.reference_W;
  const Columns X = kOwnMotion.cwiseInverse().asDiagonal() * move.X;
  const Twist whitened = kOwnMotion.cwiseInverse().asDiagonal() * y;
  // A joint that hardly moved is taken to be right: its s is held by a prior of sigma 1.
  const Eigen::Matrix3d information = X.transpose() * X + Eigen::Matrix3d::Identity();
  const Eigen::LDLT<Eigen::Matrix3d> solver(information);
  const Eigen::Vector3d s = solver.solve(X.transpose() * whitened);
  const Eigen::Matrix3d covariance = solver.solve(Eigen::Matrix3d::Identity());
  for (const JointName joint : kAllJoints) {
    const auto j = static_cast<Eigen::Index>(joint);
    if (std::abs(move.travelled[j]) < kShortest[j] || !std::isfinite(s[j])) {
      continue;
    }
    std::deque<Trial>& trials = trials_.at(static_cast<std::size_t>(joint));
    trials.push_back({s[j], 1.0 / covariance(j, j), move.travelled[j] > 0.0});
    if (trials.size() > kMoves) {
      trials.pop_front();
    }
  }
}

JointMotionWitness::Evidence JointMotionWitness::evidence(JointName joint) const {
  const std::deque<Trial>& trials = trials_.at(static_cast<std::size_t>(joint));
  Evidence evidence;
  evidence.moves = trials.size();
  double worth = 0.0;
  double sum = 0.0;
  std::size_t forward = 0;
  for (const Trial& trial : trials) {
    worth += trial.worth;
    sum += trial.worth * trial.s;
    forward += trial.forward ? 1 : 0;
  }
  if (trials.size() < kFewestMoves) {
    return evidence;
  }
  evidence.both_ways = forward > 0 && forward < trials.size();
  evidence.s = sum / worth;
  double scatter = kPriorMoves;  // in units of what the ship does by herself
  for (const Trial& trial : trials) {
    scatter += trial.worth * (trial.s - evidence.s) * (trial.s - evidence.s);
  }
  const double freedom = kPriorMoves + static_cast<double>(trials.size()) - 1.0;
  evidence.t = evidence.s / std::sqrt(scatter / freedom / worth);
  return evidence;
}

std::string JointMotionWitness::contradiction() const {
  for (const JointName joint : kAllJoints) {
    const Evidence seen = evidence(joint);
    if (seen.both_ways && std::abs(seen.s) > kLeast && std::abs(seen.t) > kBeyondChance) {
      return format_text(
          "the hull seems to move by %.2f times the %s in each of its last %zu moves: %s of %s?", seen.s,
          joint_name(joint), seen.moves, seen.s > 1.0 ? "sign" : "scale, or bias of another joint, or mount",
          joint_name(joint));
    }
  }
  return {};
}

void JointMotionWitness::forget() {
  last_.reset();
  move_.reset();
  for (auto& trials : trials_) {
    trials.clear();
  }
}

}  // namespace hulltrack
