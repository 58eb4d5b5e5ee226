#include "core/witness/machine_guess.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

TEST(MachineGuess, EveryErrorOfAJointIsHalfAStepFromAGuess) {
  const std::array<double, 3> step = {0.35, radians(0.3), radians(0.3)};
  const std::array<double, 3> least = {0.4, radians(0.6), radians(1.1)};  // what planes show by themselves
  const std::array<double, 3> most = {5.5, radians(3.7), radians(5.2)};   // ICD 3.1
  for (const JointName joint : kAllJoints) {
    const auto j = static_cast<std::size_t>(joint);
    std::vector<double> amounts;
    for (std::size_t i = 0; i < kMachineGuesses; ++i) {
      if (const MachineGuess guess = machine_guess(i); guess.joint == joint) {
        amounts.push_back(guess.amount);
      }
    }
    for (double error = least.at(j); error < most.at(j); error += 0.01 * step.at(j)) {
      for (const double signed_error : {error, -error}) {
        const auto nearest = std::min_element(amounts.begin(), amounts.end(), [&](double a, double b) {
          return std::abs(a - signed_error) < std::abs(b - signed_error);
        });
        ASSERT_NE(nearest, amounts.end());
        EXPECT_LE(std::abs(*nearest - signed_error), 0.51 * step.at(j))
            << joint_name(joint) << " " << signed_error;
      }
    }
  }
}

TEST(MachineGuess, TheFirstOfAJointMayBeWearAndTheOthersNot) {
  std::array<int, 3> may_be_wear{};
  for (std::size_t i = 0; i < kMachineGuesses; ++i) {
    const MachineGuess guess = machine_guess(i);
    if (guess.joint && !guess.beyond_wear) {
      ++may_be_wear.at(static_cast<std::size_t>(*guess.joint));
    }
  }
  EXPECT_EQ(may_be_wear, (std::array<int, 3>{2, 2, 2})) << "to either side";
}

TEST(MachineGuess, PutsTheSensorWhereSuchAMachineWouldBe) {
  const MachineConfig machine = testing::quay_machine();
  const Joints reported{3.0, radians(80.0), radians(-2.0)};
  for (std::size_t i = 0; i < kMachineGuesses; ++i) {
    const MachineGuess guess = machine_guess(i);
    const Pose E = se3_exp(twist_of(guess, machine, testing::stand_at(reported)));
    if (!guess.joint) {
      const Eigen::Vector3d sensor_W = testing::stand_at(reported).sensor_W;
      EXPECT_LT((E * sensor_W - sensor_W).norm(), 1e-9) << "it turns about the sensor";
      EXPECT_NEAR(Eigen::AngleAxisd(E.rotation()).angle(), std::abs(guess.amount), 1e-9);
      continue;
    }
    Joints truth = reported;
    (*guess.joint == JointName::travel ? truth.d_x
     : *guess.joint == JointName::slew ? truth.theta_r
                                       : truth.theta_p) -= guess.amount;
    const Pose expected = testing::misplaced(reported, truth);
    EXPECT_TRUE(E.isApprox(expected, 1e-6)) << i;
  }
}

}  // namespace
}  // namespace hulltrack
