#include "core/witness/machine_charges.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

const MachineCharge kTravel{"travel is off", JointName::travel, 1.0, 6};
const MachineCharge kSlew{"slew is off", JointName::slew, 0.02, 6};
const MachineCharge kNameless{"a mount is off", std::nullopt, 0.0, 3};

TEST(MachineCharges, EachIsDroppedByItself) {
  MachineCharges charges;
  EXPECT_FALSE(charges.any());
  EXPECT_EQ(charges.reason(), "");
  charges.add(kTravel);
  charges.add(kSlew);
  charges.add(kNameless);
  EXPECT_EQ(charges.reason(), "a mount is off");
  charges.drop(std::nullopt);
  charges.drop(JointName::slew);
  EXPECT_TRUE(charges.any());
  EXPECT_EQ(charges.reason(), "travel is off");
  charges.drop(JointName::travel);
  EXPECT_FALSE(charges.any());
}

TEST(MachineCharges, ANewOneReplacesThatOfTheSameJointOnly) {
  MachineCharges charges;
  charges.add(kTravel);
  charges.add({"travel is off by more", JointName::travel, 2.0, 6});
  charges.add(kSlew);
  for (int i = 0; i < 4; ++i) {
    const MachineCharge* asked = charges.next_joint();
    ASSERT_NE(asked, nullptr);
    EXPECT_EQ(asked->amount, asked->joint == JointName::travel ? 2.0 : 0.02);
  }
}

TEST(MachineCharges, JointsAreAskedInTurnAndWhatNamesNoneIsNoJoint) {
  MachineCharges charges;
  charges.add(kNameless);
  EXPECT_EQ(charges.next_joint(), nullptr);
  ASSERT_NE(charges.without_joint(), nullptr);
  EXPECT_EQ(charges.without_joint()->directions, 3U);
  charges.add(kTravel);
  charges.add(kSlew);
  const auto first = charges.next_joint()->joint;
  EXPECT_NE(charges.next_joint()->joint, first);
  EXPECT_EQ(charges.next_joint()->joint, first);
  charges.drop_all();
  EXPECT_EQ(charges.next_joint(), nullptr);
  EXPECT_EQ(charges.without_joint(), nullptr);
}

}  // namespace
}  // namespace hulltrack
