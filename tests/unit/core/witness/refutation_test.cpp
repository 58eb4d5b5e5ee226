#include "core/witness/refutation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

const Joints kWorking{0.0, radians(80.0), radians(-2.0)};
const auto kNeverAsked = [](const Twist&) {
  ADD_FAILURE() << "a place that shows as offsets needs no other look";
  return false;
};

/// All six directions are held to a centimetre, and the sensor is off by `off`, about its own position.
Misplacement sight(const MachineStand& stand, const Twist& off = Twist::Zero()) {
  Misplacement seen;
  seen.centre_W = stand.sensor_W + Eigen::Vector3d(3.0, -12.0, -18.0);
  seen.twist = about_point(seen.centre_W - stand.sensor_W, off);
  for (int i = 0; i < 6; ++i) {
    Twist direction = Twist::Zero();
    direction[i] = i < 3 ? 10.0 : 1.0;
    seen.measured.push_back({direction, direction.dot(seen.twist), 0.01});
  }
  return seen;
}

Twist shifted(double x, double y = 0.0, double z = 0.0) {
  Twist twist = Twist::Zero();
  twist.tail<3>() << x, y, z;
  return twist;
}

TEST(Refutation, WhatIsSeenAndWhatWearHidesTogetherHaveToBeLessThanTheCharge) {
  EXPECT_TRUE(refutes({.reads_too_much = 0.1, .hidden = 0.15}, 0.3));
  EXPECT_FALSE(refutes({.reads_too_much = 0.1, .hidden = 0.25}, 0.3));
  EXPECT_FALSE(refutes({.reads_too_much = 0.2, .hidden = 0.15}, 0.3));
  EXPECT_TRUE(refutes({.reads_too_much = -0.2, .hidden = 0.45}, 0.3)) << "off to the other side";
  EXPECT_TRUE(refutes({.reads_too_much = -0.1, .hidden = 0.15}, -0.3));
  EXPECT_FALSE(refutes({.reads_too_much = -0.2, .hidden = 0.15}, -0.3));
  EXPECT_FALSE(refutes(JointDoubt{}, 0.3)) << "nothing is measured";
}

TEST(Refutation, APlaceIsGoneWhereTheQuayIsSeenInPlaceAlongWhatWasOff) {
  const MachineConfig machine = testing::quay_machine();
  const MachineStand stand = testing::stand_at(kWorking);
  const WrongPlace charged{.stand = stand, .off = shifted(0.5), .unheld = {}};
  const Misplacement in_place = sight(stand);
  const Misplacement off = sight(stand, shifted(0.5));
  EXPECT_TRUE(refutes(charged, {machine, stand, in_place}, {}, kNeverAsked));
  EXPECT_FALSE(refutes(charged, {machine, stand, off}, {}, kNeverAsked));
  EXPECT_FALSE(refutes(charged, {machine, stand, in_place}, {shifted(0.6)}, kNeverAsked))
      << "the reference itself may be off by as much";
  Misplacement of_the_top = in_place;
  of_the_top.measured.erase(of_the_top.measured.begin() + 3);
  EXPECT_FALSE(refutes(charged, {machine, stand, of_the_top}, {}, kNeverAsked)) << "X is not seen";
}

TEST(Refutation, WhatWasNotSeenOfAPlaceMayBeAnything) {
  const MachineConfig machine = testing::quay_machine();
  const MachineStand stand = testing::stand_at(kWorking);
  const Misplacement in_place = sight(stand);
  EXPECT_FALSE(refutes({.stand = stand, .off = shifted(0.5), .unheld = {shifted(1.0)}},
                       {machine, stand, in_place}, {}, kNeverAsked));
}

TEST(Refutation, APlaceMayTurnWithTheBoomOrStayInW) {
  const MachineConfig machine = testing::quay_machine();
  const MachineStand then = testing::stand_at(kWorking);
  Joints turned = kWorking;
  turned.theta_r += radians(180.0);
  const MachineStand now = testing::stand_at(turned);
  const WrongPlace charged{.stand = then, .off = shifted(0.5), .unheld = {}};
  const auto gone_at = [&](const Misplacement& seen) {
    return refutes(charged, {machine, now, seen}, {}, kNeverAsked);
  };
  EXPECT_TRUE(gone_at(sight(now)));
  EXPECT_FALSE(gone_at(sight(now, shifted(0.5)))) << "as a wrong travel: it has stayed";
  EXPECT_FALSE(gone_at(sight(now, shifted(-0.5)))) << "as a mount: the boom has carried it along";
}

TEST(Refutation, APlaceTooFarOffForOffsetsHasToBeMissedThereToo) {
  const MachineConfig machine = testing::quay_machine();
  const MachineStand stand = testing::stand_at(kWorking);
  const WrongPlace charged{.stand = stand, .off = shifted(1.5), .unheld = {}, .beyond_gate = true};
  const Misplacement in_place = sight(stand);
  int asked = 0;
  const auto answer = [&](bool missed) {
    return [&asked, missed](const Twist& off) {
      ++asked;
      EXPECT_NEAR(off[3], 1.5, 1e-9);
      return missed;
    };
  };
  EXPECT_FALSE(refutes(charged, {machine, stand, in_place}, {}, answer(false)));
  EXPECT_TRUE(refutes(charged, {machine, stand, in_place}, {}, answer(true)));
  EXPECT_EQ(asked, 3) << "once, then as carried by the boom and as it stays";
}

TEST(Refutation, LateValuesAreRefutedWhileTheSameJointsMove) {
  const MachineConfig machine = testing::quay_machine();
  MachineStand stand = testing::stand_at(kWorking, {0.5, 0.0, 0.0});
  const Misplacement at_rest = sight(stand);
  const WrongLatency charged{.older = 0.4, .rate = {0.5, 0.0, 0.0}};
  EXPECT_TRUE(refutes(charged, {machine, stand, sight(stand)}, at_rest));
  EXPECT_FALSE(refutes(charged, {machine, stand, sight(stand, shifted(-0.2))}, at_rest))
      << "0.4 s at 0.5 m/s";
  stand.rate = {0.0, radians(2.0), 0.0};
  EXPECT_FALSE(refutes(charged, {machine, stand, sight(stand)}, at_rest)) << "another joint moves";
}

}  // namespace
}  // namespace hulltrack
