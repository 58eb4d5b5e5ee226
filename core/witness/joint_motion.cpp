#include "core/witness/joint_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"

namespace hulltrack {
namespace {

// A joint that moves by less gives no trial, by JointName, m and rad: it says little.
const Eigen::Vector3d kShortest(0.5, radians(2.0), radians(1.0));
// A move ends this long after the joints have stopped: the pose takes as long to settle.
constexpr Nanoseconds kSettles = std::chrono::milliseconds(300);
constexpr Nanoseconds kLongest = std::chrono::seconds(10);    // a move is ended after this
constexpr Nanoseconds kGap = std::chrono::milliseconds(500);  // frames farther apart: a move is dropped

// A moored ship's own motion within ten seconds, 1 sigma; rotation, then translation, rad and m. She rolls
// and pitches with the waves, and ranges at her lines with half a period of 15 s and more.
const Twist kOwnMotion = (Twist() << radians(0.3), radians(0.1), radians(0.1), 0.15, 0.10, 0.05).finished();
// The prior for the scatter, that the ship moves by kOwnMotion, counts as this many moves.
constexpr double kPriorMoves = 10.0;

// A joint is contradicted if |t| is larger. One machine in a million reaches this by chance, two-sided, with
// 13 degrees of freedom (four moves and the prior). With more moves it is rarer still.
constexpr double kBeyondChance = 8.7;
// A joint is contradicted only if |s| is larger. A smaller s may be an encoder's drift within the wear class
// over a short move: 0.05 deg of 2.5 deg.
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
  // The identity is a prior of sigma 1 on each s: the s of a joint that hardly moved stays near 0.
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

JointMotionWitness::Statistics JointMotionWitness::statistics(JointName joint) const {
  const std::deque<Trial>& trials = trials_.at(static_cast<std::size_t>(joint));
  Statistics statistics;
  statistics.moves = trials.size();
  double weight = 0.0;
  double sum = 0.0;
  std::size_t forward = 0;
  for (const Trial& trial : trials) {
    weight += trial.weight;
    sum += trial.weight * trial.s;
    forward += trial.forward ? 1 : 0;
  }
  if (trials.size() < kFewestMoves) {
    return statistics;
  }
  statistics.both_ways = forward > 0 && forward < trials.size();
  statistics.s = sum / weight;
  double scatter = kPriorMoves;  // sum of squares in units of the ship's usual motion: about 1 a move
  for (const Trial& trial : trials) {
    scatter += trial.weight * (trial.s - statistics.s) * (trial.s - statistics.s);
  }
  const double freedom = kPriorMoves + static_cast<double>(trials.size()) - 1.0;
  statistics.t = statistics.s / std::sqrt(scatter / freedom / weight);
  return statistics;
}

std::string JointMotionWitness::contradiction() const {
  for (const JointName joint : kAllJoints) {
    const Statistics seen = statistics(joint);
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
