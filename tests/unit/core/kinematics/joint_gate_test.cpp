#include "core/kinematics/joint_gate.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/geometry/se3.hpp"

namespace hulltrack {
namespace {

using Verdict = JointGate::Verdict;
using std::chrono::milliseconds;

JointGateConfig config(bool heartbeat = true) {
  return {.travel = {-500.0, 500.0, 1.0},
          .slew = {radians(-360.0), radians(360.0), radians(3.0)},
          .luff = {radians(-90.0), radians(90.0), radians(3.0)},
          .poll_period = milliseconds(20),
          .has_heartbeat = heartbeat};
}

/// Offers travel values at 20 ms steps, the other joints at rest.
class Poller {
 public:
  explicit Poller(bool heartbeat = true) : gate_(config(heartbeat)) {}

  JointGate::Outcome travel(double d_x, int steps = 1) { return offer({d_x, 0.0, 0.0}, steps); }
  JointGate::Outcome offer(const Joints& joints, int steps = 1) {
    time_ += steps * milliseconds(20);
    return gate_.offer({{time_, joints}, ++heartbeat_});
  }
  JointGate& gate() { return gate_; }
  JointReading last(double d_x) {
    time_ += milliseconds(20);
    return {{time_, {d_x, 0.0, 0.0}}, heartbeat_};
  }

 private:
  JointGate gate_;
  MeasurementTime time_{};
  std::uint16_t heartbeat_ = 0;
};

TEST(JointGate, UnchangedHeartbeatBringsNoSample) {
  Poller poller;
  EXPECT_EQ(poller.travel(1.0).verdict, Verdict::believed);
  EXPECT_EQ(poller.gate().offer(poller.last(1.0)).verdict, Verdict::no_news);
  EXPECT_EQ(poller.travel(1.0).verdict, Verdict::believed);
}

TEST(JointGate, WithoutHeartbeatEveryPollIsASample) {
  Poller poller(false);
  EXPECT_EQ(poller.travel(1.0).verdict, Verdict::believed);
  EXPECT_EQ(poller.gate().offer(poller.last(1.0)).verdict, Verdict::believed);
}

TEST(JointGate, ValuesOutOfRangeOrNotFiniteAreRefusedAndNamed) {
  for (const double bad :
       {500.1, -500.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Poller poller;
    EXPECT_EQ(poller.travel(0.0).verdict, Verdict::believed);
    const auto refused = poller.travel(bad);
    EXPECT_EQ(refused.verdict, Verdict::refused) << bad;
    EXPECT_EQ(refused.faults, fault::plc_value);
    EXPECT_NE(refused.reason.find("travel"), std::string::npos) << refused.reason;
    EXPECT_EQ(poller.travel(0.0).verdict, Verdict::believed) << "one poll later";
  }
}

TEST(JointGate, FullSpeedIsBelieved) {
  Poller poller;
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(poller.travel(0.02 * i).verdict, Verdict::believed) << i;
  }
}

TEST(JointGate, StepIsNeverBelievedByWaiting) {
  Poller poller;
  ASSERT_EQ(poller.travel(10.0).verdict, Verdict::believed);
  for (int i = 0; i < 20'000; ++i) {  // 400 s: time enough for 400 m at max_rate
    ASSERT_EQ(poller.travel(11.0).verdict, Verdict::refused) << i;
  }
  EXPECT_EQ(poller.travel(10.01).verdict, Verdict::believed) << "the value has come back";
}

TEST(JointGate, MovingJointAfterAStepStaysRefused) {
  Poller poller;
  ASSERT_EQ(poller.travel(10.0).verdict, Verdict::believed);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(poller.travel(20.0 + 0.01 * i).verdict, Verdict::refused) << i;
  }
}

TEST(JointGate, OneSpikeOnAMovingJointCostsOneSample) {
  Poller poller;
  double d_x = 0.0;
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(poller.travel(d_x += 0.02).verdict, Verdict::believed);
  }
  d_x += 0.02;
  EXPECT_EQ(poller.travel(300.0).verdict, Verdict::refused);
  EXPECT_EQ(poller.travel(d_x += 0.02).verdict, Verdict::believed);
}

TEST(JointGate, LongSpikeIsBelievedAgainWithin250Milliseconds) {
  Poller poller;
  ASSERT_EQ(poller.travel(0.0).verdict, Verdict::believed);
  for (int i = 0; i < 9; ++i) {
    ASSERT_EQ(poller.travel(300.0).verdict, Verdict::refused);
  }
  EXPECT_EQ(poller.travel(0.2).verdict, Verdict::believed) << "0.2 m in 0.2 s at 1 m/s, breaks with 300 m";
}

TEST(JointGate, AfterALongSpikeOnlyTheOldPlaceIsBelieved) {
  Poller poller;
  ASSERT_EQ(poller.travel(0.0).verdict, Verdict::believed);
  for (int i = 0; i < 500; ++i) {
    ASSERT_EQ(poller.travel(300.0).verdict, Verdict::refused);
  }
  EXPECT_EQ(poller.travel(2.0).verdict, Verdict::refused)
      << "10 s would allow 10 m, but time makes nothing true";
  EXPECT_EQ(poller.travel(0.02).verdict, Verdict::believed);
}

TEST(JointGate, ReacquireBelievesTheNextValueInRange) {
  Poller poller;
  ASSERT_EQ(poller.travel(10.0).verdict, Verdict::believed);
  ASSERT_EQ(poller.travel(200.0).verdict, Verdict::refused);
  poller.gate().reacquire();
  EXPECT_EQ(poller.travel(200.0).verdict, Verdict::believed);
}

TEST(JointGate, GapInTheLinkAllowsTheMoveThatItsTimeAllows) {
  Poller poller;
  ASSERT_EQ(poller.travel(10.0).verdict, Verdict::believed);
  EXPECT_EQ(poller.travel(12.0, 100).verdict, Verdict::believed) << "2 m in 2 s";
  EXPECT_EQ(poller.travel(15.0, 100).verdict, Verdict::refused) << "3 m in 2 s";
}

TEST(JointGate, EachJointIsJudgedAlone) {
  Poller poller;
  ASSERT_EQ(poller.offer({0.0, 0.0, 0.0}).verdict, Verdict::believed);
  for (int i = 1; i <= 100; ++i) {  // luff broken while the gantry travels on
    const auto outcome = poller.offer({0.02 * i, 0.0, radians(45.0)});
    ASSERT_EQ(outcome.verdict, Verdict::refused);
    ASSERT_NE(outcome.reason.find("luff 45.000 deg"), std::string::npos) << outcome.reason;
  }
  EXPECT_EQ(poller.offer({2.02, 0.0, 0.0}).verdict, Verdict::believed) << "the gantry was believed all along";
}

}  // namespace
}  // namespace hulltrack
