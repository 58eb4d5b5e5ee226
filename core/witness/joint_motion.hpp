// Does the hull seem to move whenever a joint of the loader moves? No ship does: such a joint reads wrongly.
//
// - If a joint reads a step dq_read but really makes dq_true, the hull seems to move by s times the motion
//   that dq_read gives a point at the hull: s = 1 - dq_true / dq_read. s is 0 for a right joint, 2 for a
//   wrong sign, 0.02 for a scale that is 2 % off.
// - A move is a motion of the machine from rest to rest, ten seconds at most. Each move is one trial: least
//   squares give an s of each joint from y = X s + the ship's own motion. y is the hull's apparent motion, X
//   has for each joint the column that y would be with s = 1.
// - The mean of s over the moves is tested against zero by Student's t. A ship does not know which way the
//   joint goes, so her own motion makes s scatter. The scatter has a prior: a moored ship's usual motion. A
//   verdict takes several moves, in both directions.
// Input: the hull's poses and the machine's stands, frame by frame. Frame W, about the hull's reference
// point; metres, radians. Failure: no verdict on a joint that does not move. Thread rule: one owner. Cost: a
// few microseconds.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>

#include "core/base/time.hpp"
#include "core/witness/machine_wear.hpp"

namespace hulltrack {

class JointMotionWitness {
 public:
  /// Of each joint this many moves are remembered; with fewer than kFewestMoves there is no verdict.
  static constexpr std::size_t kMoves = 40;
  static constexpr std::size_t kFewestMoves = 4;

  explicit JointMotionWitness(const MachineConfig& machine) : machine_(machine) {}

  /// To be called once for each frame whose pose the scan does not contradict, in order of time.
  /// `reference_W`, `R_W_H`: the hull's reference point and attitude by that pose.
  void add(MeasurementTime time, const MachineStand& stand, const Eigen::Vector3d& reference_W,
           const Eigen::Matrix3d& R_W_H);

  /// What the moves so far show of a joint; s and t are 0 with fewer than kFewestMoves.
  struct Statistics {
    std::size_t moves = 0;
    double s = 0.0;          // mean over the moves, no unit
    double t = 0.0;          // Student's t: s divided by its standard error
    bool both_ways = false;  // there are moves of both signs
  };
  [[nodiscard]] Statistics statistics(JointName joint) const;

  /// Why the machine is contradicted, in words with figures; empty if it is not.
  [[nodiscard]] std::string contradiction() const;

  void forget();

 private:
  static constexpr std::size_t kJoints = 3;
  using Columns = Eigen::Matrix<double, 6, 3>;
  struct Moment {
    MeasurementTime time;
    Joints joints;
    Eigen::Vector3d reference_W;
    Eigen::Matrix3d R_W_H;
  };
  struct Move {
    Moment begin;
    MeasurementTime last_moving;
    Columns X = Columns::Zero();
    Eigen::Vector3d travelled = Eigen::Vector3d::Zero();  // sum of each joint's steps, with sign, m or rad
  };
  struct Trial {
    double s;
    double weight;  // 1 / variance of s, if the ship moves as usual
    bool forward;   // the joint's value grew
  };
  void finish(const Move& move, const Moment& end);

  MachineConfig machine_;
  std::optional<Moment> last_;
  std::optional<Move> move_;
  std::array<std::deque<Trial>, kJoints> trials_;
};

}  // namespace hulltrack
