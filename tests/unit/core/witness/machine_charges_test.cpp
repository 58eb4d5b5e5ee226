#include "core/witness/machine_charges.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

const MachineCharge kTravel{"travel is off", WrongJoint{JointName::travel, 1.0}};
const MachineCharge kSlew{"slew is off", WrongJoint{JointName::slew, 0.02}};
const MachineCharge kLate{"values are late", WrongLatency{0.2}};
const MachineCharge kPlace{"a mount is off", WrongPlace{}};
const MachineCharge kAltogether{"the quay is seen through", WrongAltogether{}};

template <typename Wrong>
void refute(MachineCharges& charges) {
  for (int i = 0; i < MachineCharges::kNeeded; ++i) {
    charges.hear<Wrong>(true);
  }
}

void refute(MachineCharges& charges, JointName joint) {
  for (int i = 0; i < MachineCharges::kNeeded; ++i) {
    charges.hear(joint, true);
  }
}

TEST(MachineCharges, EachIsDroppedByItself) {
  MachineCharges charges;
  EXPECT_FALSE(charges.any());
  EXPECT_EQ(charges.reason(), "");
  for (const MachineCharge& charge : {kTravel, kSlew, kLate, kAltogether, kPlace}) {
    charges.add(charge);
  }
  EXPECT_EQ(charges.reason(), "a mount is off");
  refute<WrongPlace>(charges);
  EXPECT_FALSE(charges.charged<WrongPlace>());
  EXPECT_TRUE(charges.charged<WrongLatency>());
  EXPECT_TRUE(charges.charged<WrongAltogether>());
  refute<WrongAltogether>(charges);
  refute<WrongLatency>(charges);
  refute(charges, JointName::slew);
  EXPECT_TRUE(charges.any());
  EXPECT_EQ(charges.reason(), "travel is off");
  refute(charges, JointName::travel);
  EXPECT_FALSE(charges.any());
}

TEST(MachineCharges, FramesThatRefuteItHaveToFollowEachOther) {
  MachineCharges charges;
  charges.add(kTravel);
  charges.add(kPlace);
  for (const bool refuted : {true, true, false, true, true}) {
    charges.hear(JointName::travel, refuted);
    charges.hear<WrongPlace>(refuted);
  }
  charges.refute_none();
  charges.hear(JointName::travel, true);
  charges.hear(JointName::travel, true);
  EXPECT_TRUE(charges.next_joint()) << "neither what refutes nothing nor another charge is passed over";
  charges.add(kTravel);
  charges.hear(JointName::travel, true);
  EXPECT_TRUE(charges.next_joint()) << "charged anew";
  charges.hear(JointName::travel, true);
  charges.hear(JointName::travel, true);
  EXPECT_FALSE(charges.next_joint());
  EXPECT_TRUE(charges.charged<WrongPlace>());
}

TEST(MachineCharges, ANewOneReplacesThatOfTheSameJointOrKindOnly) {
  MachineCharges charges;
  charges.add(kTravel);
  charges.add({"travel is off by more", WrongJoint{JointName::travel, 2.0}});
  charges.add(kSlew);
  charges.add(kLate);
  charges.add({"values are later", WrongLatency{0.3}});
  for (int i = 0; i < 4; ++i) {
    const auto asked = charges.next_joint();
    ASSERT_TRUE(asked);
    EXPECT_EQ(asked->amount, asked->joint == JointName::travel ? 2.0 : 0.02);
  }
  EXPECT_EQ(charges.charged<WrongLatency>()->older, 0.3);
}

TEST(MachineCharges, JointsAreAskedInTurnAndWhatNamesNoneIsNoJoint) {
  MachineCharges charges;
  charges.add(kPlace);
  charges.add(kLate);
  charges.add(kAltogether);
  EXPECT_FALSE(charges.next_joint());
  charges.add(kTravel);
  charges.add(kSlew);
  const auto first = charges.next_joint()->joint;
  EXPECT_NE(charges.next_joint()->joint, first);
  EXPECT_EQ(charges.next_joint()->joint, first);
  charges.drop_all();
  EXPECT_FALSE(charges.next_joint());
  EXPECT_FALSE(charges.any());
}

}  // namespace
}  // namespace hulltrack
