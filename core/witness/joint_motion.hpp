// Does the hull move in time with the loader's joints? No ship does, so then a joint is not what it reads.
//
// A joint that reads q while the machine turns or travels by another amount lets the hull seem to move by s
// times the joint's own motion: s = 1 - dq_true / dq_read, so 2 with a wrong sign, 0.02 with a scale that is
// 2 % off. Every move of the machine (from rest to rest, at most ten seconds) is one trial: by how much did
// the hull seem to move (y), by how much would it have with s = 1 (one column of X a joint)? s of a move is
// the least squares answer under what a moored ship does by herself meanwhile. Over the moves s has a mean
// and a scatter; a ship that surges, is warped or sinks scatters, since she does not know which way the joint
// goes. Student's t of the mean, with the ship's usual motion as a prior for the scatter, is the evidence: it
// takes several moves, to and fro. No moving joint, no verdict. Frame W, about the hull's reference point;
// metres, radians. Thread rule: one owner. Cost: a few microseconds.
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
  /// Moves that are remembered of each joint.
  static constexpr std::size_t kMoves = 40;
  static constexpr std::size_t kFewestMoves = 4;

  explicit JointMotionWitness(const MachineConfig& machine) : machine_(machine) {}

  /// Once a frame whose pose the scan does not contradict: where the reference point seems to be and how the
  /// hull seems to lie. Frames come in order of time.
  void add(MeasurementTime time, const MachineStand& stand, const Eigen::Vector3d& reference_W,
           const Eigen::Matrix3d& R_W_H);

  /// What the moves so far say of a joint.
  struct Evidence {
    std::size_t moves = 0;
    double s = 0.0;  // mean over the moves
    double t = 0.0;  // Student's t of it
    bool both_ways = false;
  };
  [[nodiscard]] Evidence evidence(JointName joint) const;

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
    Eigen::Vector3d travelled = Eigen::Vector3d::Zero();  // of each joint, m, rad, with sign
  };
  struct Trial {
    double s;
    double worth;  // 1 / variance
    bool forward;
  };
  void finish(const Move& move, const Moment& end);

  MachineConfig machine_;
  std::optional<Moment> last_;
  std::optional<Move> move_;
  std::array<std::deque<Trial>, kJoints> trials_;
};

}  // namespace hulltrack
