#include "core/witness/machine_doubt.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

using testing::misplaced;
using testing::quay_machine;
using testing::stand_at;

const Joints kWorking{12.0, radians(95.0), radians(-3.0)};

/// All six axes measured to 5 mm and 0.03 deg about a point on the quay, the sensor moved by `twist` about
/// it.
Misplacement measured(const Twist& twist, const Eigen::Vector3d& centre_W, int axes = 6) {
  Misplacement seen;
  seen.centre_W = centre_W;
  seen.twist = twist;
  seen.observations = seen.agreeing = 400;
  for (int i = 6 - axes; i < 6; ++i) {
    Twist direction = Twist::Zero();
    direction[i] = i < 3 ? 10.0 : 1.0;
    seen.measured.push_back({direction, direction.dot(twist), 0.005});
  }
  return seen;
}

const Eigen::Vector3d kQuay{10.0, -10.0, 1.0};

TEST(MachineWear, AJointsTwistIsTheDerivativeOfTheBoomsPose) {
  const MachineStand stand = stand_at(kWorking);
  constexpr double kStep = 1e-6;
  for (const JointName joint : kAllJoints) {
    Joints more = kWorking;
    (joint == JointName::travel ? more.d_x : joint == JointName::slew ? more.theta_r : more.theta_p) += kStep;
    const Pose E = misplaced(more, kWorking);
    Twist expected;
    expected << so3_log(E.linear()) / kStep, (E * kQuay - kQuay) / kStep;
    const Twist twist = joint_twist(quay_machine(), stand, joint, kQuay);
    EXPECT_LT((twist - expected).norm(), 1e-4) << joint_name(joint);
  }
}

TEST(MachineDoubt, WearWithinTheClassAccusesNobodyWhateverItsSigns) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (const double d_x : {-28.0, 0.0, 30.0}) {
    for (const double slew : {56.0, 90.0, 124.0}) {
      const MachineStand stand = stand_at({d_x, radians(slew), radians(2.0)}, {0.4, 0.0, 0.0});
      const std::vector<Twist> wear = wear_twists(quay_machine(), stand, kQuay);
      int accused = 0;
      for (int run = 0; run < 300; ++run) {
        Twist twist = Twist::Zero();
        for (const Twist& term : wear) {
          twist += part(random) * term;
        }
        accused += doubt_machine(quay_machine(), stand, measured(twist, kQuay)).beyond_class ? 1 : 0;
      }
      EXPECT_LE(accused, 1) << d_x << " m, " << slew << " deg: three sigma, of 300 machines";
      for (const Twist& term : wear) {
        EXPECT_FALSE(doubt_machine(quay_machine(), stand, measured(term, kQuay)).beyond_class)
            << "one term alone, at its limit";
      }
    }
  }
}

TEST(MachineDoubt, AJointThatReadsMoreThanWearExplainsIsAccusedByNameAndAmount) {
  const MachineStand stand = stand_at(kWorking);
  for (const JointName joint : kAllJoints) {
    const Twist unit = joint_twist(quay_machine(), stand, joint, kQuay);
    const double hidden = doubt_machine(quay_machine(), stand, measured(Twist::Zero(), kQuay))
                              .joints.at(std::size_t(joint))
                              .hidden;
    for (const double sign : {1.0, -1.0}) {
      const Misplacement seen = measured(sign * 1.2 * hidden * unit, kQuay);
      const MachineDoubt doubt = doubt_machine(quay_machine(), stand, seen);
      ASSERT_TRUE(doubt.accused) << joint_name(joint);
      EXPECT_EQ(*doubt.accused, joint);
      EXPECT_NEAR(doubt.joints.at(std::size_t(joint)).reads_too_much, sign * 1.2 * hidden, 1e-9);
      const std::string words = describe(doubt, seen);
      EXPECT_NE(words.find(joint_name(joint)), std::string::npos) << words;
      EXPECT_NE(words.find(sign > 0.0 ? "much" : "little"), std::string::npos) << words;
    }
    EXPECT_FALSE(doubt_machine(quay_machine(), stand, measured(0.9 * hidden * unit, kQuay)).accused);
  }
}

// What the manual promises of a quay that shows all axes: amounts that are seen whatever wear does meanwhile.
TEST(MachineDoubt, TravelOfThirteenCentimetresAndSlewOfHalfADegreeCannotHide) {
  for (const double slew : {56.0, 90.0, 124.0}) {
    const MachineDoubt doubt =
        doubt_machine(quay_machine(), stand_at({5.0, radians(slew), 0.0}), measured(Twist::Zero(), kQuay));
    EXPECT_LT(doubt.joints.at(0).hidden, 0.13) << slew;
    EXPECT_LT(degrees(doubt.joints.at(1).hidden), 0.5) << slew;
    EXPECT_LT(degrees(doubt.joints.at(2).hidden), 0.9) << slew << ": a boom that sags looks the same";
  }
}

TEST(MachineDoubt, AMountThatIsTurnedIsBeyondTheClassThoughNoJointIs) {
  const MachineStand stand = stand_at(kWorking);
  Twist twist;  // 1 deg about X and Y through the sensor
  const Eigen::Vector3d turn = Eigen::Vector3d(radians(1.0), radians(1.0), 0.0);
  twist << turn, turn.cross(kQuay - stand.sensor_W);
  const Misplacement seen = measured(twist, kQuay);
  const MachineDoubt doubt = doubt_machine(quay_machine(), stand, seen);
  EXPECT_TRUE(doubt.beyond_class);
  EXPECT_FALSE(describe(doubt, seen).empty());
}

TEST(MachineDoubt, AMountThatHangsThirtyCentimetresOffIsBeyondTheClassAlongEveryAxis) {
  for (const double slew : {56.0, 90.0, 124.0}) {
    const MachineStand stand = stand_at({5.0, radians(slew), 0.0});
    for (int axis = 0; axis < 3; ++axis) {
      Twist twist = Twist::Zero();
      twist[3 + axis] = 0.3;
      EXPECT_TRUE(doubt_machine(quay_machine(), stand, measured(twist, kQuay)).beyond_class)
          << "axis " << axis << ", " << slew;
    }
  }
}

TEST(MachineDoubt, WhatIsNotMeasuredHidesEverything) {
  const MachineStand stand = stand_at(kWorking);
  const MachineDoubt doubt = doubt_machine(quay_machine(), stand, measured(Twist::Zero(), kQuay, 0));
  EXPECT_FALSE(doubt.beyond_class);
  for (const JointDoubt& joint : doubt.joints) {
    EXPECT_TRUE(std::isinf(joint.hidden));
  }
}

}  // namespace
}  // namespace hulltrack
