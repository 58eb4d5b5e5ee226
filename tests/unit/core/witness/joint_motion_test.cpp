#include "core/witness/joint_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using testing::misplaced;
using testing::quay_machine;
using testing::stand_at;

constexpr double kTau = 2.0 * std::numbers::pi;
const Eigen::Vector3d kReference{-0.9, 4.9, 3.3};

/// A hull's own motion: T_W_H about the reference point at t seconds.
using Hull = std::function<Pose(double)>;

Pose hull_pose(const Eigen::Vector3d& displacement, const Eigen::Vector3d& rpy_deg) {
  return pose_about(kReference, rotation_from_rpy(rpy_deg * radians(1.0)), displacement);
}

/// Ranges at her lines as a ship in a port with some swell does.
Hull uneasy(std::mt19937& random) {
  std::uniform_real_distribution<double> phase(0.0, kTau);
  std::uniform_real_distribution<double> period(30.0, 90.0);
  const double a = phase(random), b = phase(random), c = phase(random), d = phase(random);
  const double surge = period(random), sway = period(random), yaw = period(random);
  return [=](double t) {
    return hull_pose({0.3 * std::sin(kTau * t / surge + a), 0.2 * std::sin(kTau * t / sway + b), 0.0},
                     {0.5 * std::sin(kTau * t / 8.0 + c), 0.05 * std::sin(kTau * t / 10.0 + d),
                      0.1 * std::sin(kTau * t / yaw + a)});
  };
}

Hull quiet() {
  return [](double t) {
    return hull_pose({0.01 * std::sin(kTau * t / 60.0), 0.0, 0.0},
                     {0.02 * std::sin(kTau * t / 9.0), 0.0, 0.0});
  };
}

/// The loader at work, frame by frame: one joint after the other moves to a place inside its range, and
/// rests.
class Loader {
 public:
  Loader(unsigned seed, Hull hull) : random_(seed), hull_(std::move(hull)), witness_(quay_machine()) {}

  /// `reads`: what the PLC says for true joints. Returns after how many seconds it was contradicted, and how.
  struct Outcome {
    double seconds = -1.0;
    std::string words;
  };
  Outcome run(double seconds, const std::function<Joints(const Joints&)>& reads) {
    std::normal_distribution<double> noise(0.0, 0.003);
    Outcome outcome;
    for (; t_ < seconds; t_ += 0.1) {
      work();
      const Joints read = reads(now_);
      const Pose T_W_H = misplaced(read, now_) * hull_(t_);
      const Eigen::Vector3d at =
          T_W_H * kReference + Eigen::Vector3d(noise(random_), noise(random_), noise(random_));
      witness_.add(MeasurementTime{milliseconds(100) * frame_++}, stand_at(read), at, T_W_H.linear());
      if (std::string words = witness_.contradiction(); !words.empty()) {
        return {t_, words};
      }
    }
    return outcome;
  }

 private:
  void work() {
    if (rest_ > 0.0) {
      rest_ -= 0.1;
      return;
    }
    double* joint = moving_ == 0 ? &now_.d_x : moving_ == 1 ? &now_.theta_r : &now_.theta_p;
    const double step = 0.1 * (moving_ == 0 ? 0.4 : moving_ == 1 ? radians(1.0) : radians(0.28));
    if (std::abs(target_ - *joint) > step) {
      *joint += std::copysign(step, target_ - *joint);
      return;
    }
    rest_ = 3.0;
    moving_ = (moving_ + 1) % 3;
    const std::array<std::pair<double, double>, 3> ranges = {
        {{-28.0, 30.0}, {radians(56.0), radians(124.0)}, {radians(-5.0), radians(5.0)}}};
    const std::array<double, 3> longest = {8.0, radians(25.0), radians(4.0)};
    const double from = moving_ == 0 ? now_.d_x : moving_ == 1 ? now_.theta_r : now_.theta_p;
    const auto& [low, high] = ranges.at(static_cast<std::size_t>(moving_));
    const double most = longest.at(static_cast<std::size_t>(moving_));
    target_ = std::uniform_real_distribution<double>(std::max(low, from - most),
                                                     std::min(high, from + most))(random_);
  }

  std::mt19937 random_;
  Hull hull_;
  JointMotionWitness witness_;
  Joints now_{5.0, radians(90.0), radians(1.0)};
  double t_ = 0.0, rest_ = 3.0, target_ = 1.0;
  int moving_ = 0;
  int frame_ = 0;
};

Joints honest(const Joints& q) { return q; }

TEST(JointMotion, AnHonestMachineIsNotContradictedByWhateverItsShipDoes) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 random(seed);
    const Hull swell = uneasy(random);
    const std::vector<std::pair<const char*, Hull>> hulls = {
        {"quiet", quiet()},
        {"uneasy", swell},
        {"sinks",
         [&](double t) {
           return hull_pose({0.0, 0.0, -0.002 * t}, {0.0, 0.0, 0.0}) * swell(t);
         }},
        {"is warped",
         [&](double t) {
           return hull_pose({0.2 * std::clamp(t - 30.0, 0.0, 150.0), 0.0, 0.0}, {0.0, 0.0, 0.0}) * swell(t);
         }},
        {"is jerked",
         [&](double t) {
           const double s = std::clamp((std::fmod(t, 120.0) - 20.0) / 10.0, 0.0, 1.0);
           return hull_pose({s, 0.0, 0.0}, {0.0, 0.0, 0.0}) * swell(t);
         }},
        {"lists", [&](double t) {
           return hull_pose({0.0, 0.0, 0.0}, {3.0 * std::sin(kTau * t / 90.0), 0.0, 0.0}) * swell(t);
         }}};
    for (const auto& [what, hull] : hulls) {
      const auto outcome = Loader(seed, hull).run(1800.0, honest);
      EXPECT_EQ(outcome.words, "") << what << ", seed " << seed << ", after " << outcome.seconds << " s";
    }
  }
}

TEST(JointMotion, AWrongSignIsNamedAfterAFewMoves) {
  const std::vector<std::pair<const char*, std::function<Joints(const Joints&)>>> signs = {
      {"travel",
       [](const Joints& q) {
         return Joints{-q.d_x, q.theta_r, q.theta_p};
       }},
      {"luff", [](const Joints& q) {
         return Joints{q.d_x, q.theta_r, -q.theta_p};
       }}};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    for (const auto& [joint, reads] : signs) {
      const auto outcome = Loader(seed, uneasy(random)).run(900.0, reads);
      EXPECT_NE(outcome.words.find(joint), std::string::npos) << outcome.words;
      EXPECT_NE(outcome.words.find("sign"), std::string::npos) << outcome.words;
      EXPECT_LT(outcome.seconds, 400.0) << joint;
    }
  }
}

TEST(JointMotion, AScaleIsNamedSoonerTheQuieterTheShip) {
  const auto reads = [](const Joints& q) { return Joints{q.d_x, 1.05 * q.theta_r, q.theta_p}; };
  const auto outcome = Loader(1, quiet()).run(3600.0, reads);
  EXPECT_NE(outcome.words.find("slew"), std::string::npos) << outcome.words;
  std::mt19937 random(1);
  const auto later = Loader(1, uneasy(random)).run(3600.0, reads);
  EXPECT_TRUE(later.words.empty() || later.seconds > outcome.seconds) << later.words;
}

TEST(JointMotion, AMachineThatStandsGivesNoVerdict) {
  JointMotionWitness witness(quay_machine());
  const MachineStand stand = stand_at({0.0, radians(90.0), 0.0});
  for (int i = 0; i < 3000; ++i) {
    witness.add(MeasurementTime{milliseconds(100) * i}, stand, {0.01 * i, 0.0, 0.0},
                Eigen::Matrix3d::Identity());
  }
  EXPECT_EQ(witness.contradiction(), "");
  EXPECT_EQ(witness.statistics(JointName::travel).moves, 0U);
}

}  // namespace
}  // namespace hulltrack
