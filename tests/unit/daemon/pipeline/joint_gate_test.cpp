#include "daemon/pipeline/joint_gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "core/geometry/se3.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using Verdict = JointGate::Verdict;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

JointGateConfig config(bool heartbeat = true) {
  return {.travel = {-500.0, 500.0, 1.0},
          .slew = {radians(-360.0), radians(360.0), radians(3.0)},
          .luff = {radians(-90.0), radians(90.0), radians(3.0)},
          .poll_period = milliseconds(20),
          .has_heartbeat = heartbeat};
}

/// A PLC that is polled every 20 ms. `travel(t)` in m, t in s from its first poll; the other joints rest.
class Poller {
 public:
  explicit Poller(const JointGateConfig& settings = config()) : gate_(settings) {}

  JointGate::Outcome offer(const Joints& joints) {
    time_ += milliseconds(20);
    return gate_.offer({{time_, joints}, ++heartbeat_});
  }
  JointGate::Outcome travel(double d_x) { return offer({d_x, 0.0, 0.0}); }
  /// For so long; gives the last outcome and counts those that are believed.
  JointGate::Outcome run(Nanoseconds duration, const std::function<double(double)>& travel_at) {
    JointGate::Outcome outcome;
    believed = 0;
    for (const MeasurementTime end = time_ + duration; time_ < end;) {
      outcome = travel(travel_at(to_seconds(time_.time_since_epoch() + milliseconds(20))));
      believed += outcome.verdict == Verdict::believed ? 1 : 0;
    }
    return outcome;
  }
  JointGate::Outcome stand(Nanoseconds duration, double d_x) {
    return run(duration, [d_x](double) { return d_x; });
  }
  /// The link is away.
  void nothing(Nanoseconds duration) { time_ += duration; }

  JointGate& gate() { return gate_; }
  [[nodiscard]] MeasurementTime now() const { return time_; }
  [[nodiscard]] std::uint16_t heartbeat() const { return heartbeat_; }
  int believed = 0;

 private:
  JointGate gate_;
  MeasurementTime time_{};
  std::uint16_t heartbeat_ = 0;
};

/// Half of full speed, along the rails.
double cruise(double t) { return 10.0 + 0.5 * t; }

TEST(JointGate, UnchangedHeartbeatBringsNoSample) {
  Poller poller;
  EXPECT_EQ(poller.travel(1.0).verdict, Verdict::believed);
  const JointReading again{{poller.now() + milliseconds(20), {1.0, 0.0, 0.0}}, poller.heartbeat()};
  EXPECT_EQ(poller.gate().offer(again).verdict, Verdict::no_news);
  EXPECT_EQ(poller.travel(1.0).verdict, Verdict::believed);
}

TEST(JointGate, WithoutHeartbeatEveryPollIsASample) {
  Poller poller(config(false));
  EXPECT_EQ(poller.travel(1.0).verdict, Verdict::believed);
  const JointReading again{{poller.now() + milliseconds(20), {1.0, 0.0, 0.0}}, poller.heartbeat()};
  EXPECT_EQ(poller.gate().offer(again).verdict, Verdict::believed);
}

TEST(JointGate, ValuesOutOfRangeOrNotFiniteAreRefusedAndNamed) {
  for (const double bad : {500.1, -500.1, kNan, std::numeric_limits<double>::infinity()}) {
    Poller poller;
    poller.stand(seconds(1), 0.0);
    const auto refused = poller.travel(bad);
    EXPECT_EQ(refused.verdict, Verdict::refused) << bad;
    EXPECT_EQ(refused.faults, fault::plc_value);
    EXPECT_THAT(refused.reason, HasSubstr("travel"));
    EXPECT_EQ(poller.travel(0.0).verdict, Verdict::believed) << "one poll later";
  }
}

TEST(JointGate, FullSpeedIsBelieved) {
  Poller poller;
  poller.run(seconds(4), [](double t) { return t; });
  EXPECT_EQ(poller.believed, 200);
}

TEST(JointGate, OneSpikeOnAMovingJointCostsOneSample) {
  Poller poller;
  poller.run(seconds(1), cruise);
  EXPECT_EQ(poller.travel(300.0).verdict, Verdict::refused);
  poller.run(seconds(1), cruise);
  EXPECT_EQ(poller.believed, 50);
}

TEST(JointGate, ATornFloatIsRefusedAtSpeedAndAtRest) {
  for (const double v : {0.0, 0.5}) {
    for (const double torn : {0.0625, -0.0625}) {  // a float32 between 8 and 16 m, of two PLC cycles
      Poller poller;
      poller.run(seconds(1), [v](double t) { return 10.0 + v * t; });
      const double next = 10.0 + v * 1.02;
      EXPECT_EQ(poller.travel(next + torn).verdict, Verdict::refused) << v << " m/s";
      EXPECT_EQ(poller.travel(next + 0.02 * v).verdict, Verdict::believed) << "the next one";
    }
  }
}

TEST(JointGate, AMachineMayBrakeAsHardAsItCan) {
  Poller poller;
  poller.run(seconds(2), cruise);
  const double braked_from = cruise(2.0);
  poller.run(seconds(2), [&](double t) {  // .9 m/s^2
    const double u = std::min(t - 2.0, 0.5 / 0.9);
    return braked_from + 0.5 * u - 0.45 * u * u;
  });
  EXPECT_EQ(poller.believed, 100);
}

TEST(JointGate, AStepIsNeverBelievedByWaiting) {
  Poller poller;
  poller.stand(seconds(1), 10.0);
  const auto waiting = poller.stand(seconds(400), 11.0);  // time enough for 400 m at max_rate
  EXPECT_EQ(poller.believed, 0);
  EXPECT_EQ(waiting.verdict, Verdict::on_trial);
  EXPECT_TRUE(waiting.needs_edge);
  EXPECT_EQ(waiting.faults, fault::plc_value);
  EXPECT_THAT(waiting.reason, HasSubstr("wait for a re-acquire edge (command bit 1): none was believed for "
                                        "400.0 s, travel was 10.000 m then and is 11.000 m now"));
}

TEST(JointGate, AMovingJointAfterAStepIsNotBelieved) {
  Poller poller;
  poller.run(seconds(2), cruise);
  EXPECT_TRUE(poller.run(seconds(30), [](double t) { return cruise(t) + 3.0; }).needs_edge);
  EXPECT_EQ(poller.believed, 0);
}

TEST(JointGate, ReachNeverGrowsWhileNothingIsBelieved) {
  Poller poller;
  poller.stand(seconds(2), 100.0);
  poller.stand(seconds(12), kNan);
  poller.stand(seconds(30), 103.0);
  EXPECT_EQ(poller.believed, 0) << "12 s would allow 12 m, but time makes nothing true";
  poller.nothing(seconds(60));
  poller.stand(seconds(30), 100.5);
  EXPECT_EQ(poller.believed, 0);
}

TEST(JointGate, AfterAGapAMachineThatStoodIsBelievedWhereItStood) {
  Poller poller;
  poller.stand(seconds(1), 10.0);
  poller.nothing(seconds(40));
  EXPECT_EQ(poller.stand(milliseconds(240), 10.019).verdict, Verdict::on_trial);
  EXPECT_EQ(poller.stand(milliseconds(40), 10.019).verdict, Verdict::believed);
}

TEST(JointGate, StandstillAloneConfirmsNothing) {
  Poller poller;
  poller.stand(seconds(1), 10.0);
  poller.nothing(seconds(2));
  EXPECT_TRUE(poller.stand(seconds(60), 10.021).needs_edge) << "elsewhere";
  EXPECT_EQ(poller.believed, 0);

  Poller moved;
  moved.run(seconds(2), cruise);
  moved.nothing(seconds(2));
  EXPECT_TRUE(moved.stand(seconds(60), cruise(2.0)).needs_edge) << "it moved before";
  EXPECT_EQ(moved.believed, 0);
}

TEST(JointGate, ValuesThatSweepPastTheOldPlaceAreNotBelieved) {
  Poller poller;
  poller.stand(seconds(1), 10.0);
  poller.nothing(seconds(10));
  poller.run(seconds(10), [](double t) { return 9.0 + 0.2 * (t - 11.0); });
  EXPECT_EQ(poller.believed, 0);
}

TEST(JointGate, OneMotionThroughAShortGapIsBelieved) {
  for (const bool link_lost : {false, true}) {
    Poller poller;
    poller.run(seconds(2), cruise);
    link_lost ? poller.nothing(milliseconds(900)) : void(poller.stand(milliseconds(900), kNan));
    EXPECT_EQ(poller.run(milliseconds(500), cruise).verdict, Verdict::on_trial) << "its speed is not known";
    EXPECT_EQ(poller.run(milliseconds(100), cruise).verdict, Verdict::believed);
  }
}

TEST(JointGate, AMachineThatBrakedEvenlyInAShortGapIsBelieved) {
  const auto braking = [](double t) {  // from .2 m/s, at .2 m/s^2, between 2.0 and 3.0 s
    const double u = std::clamp(t - 2.0, 0.0, 1.0);
    return 10.0 + 0.2 * std::min(t, 2.0) + 0.2 * u - 0.1 * u * u;
  };
  Poller poller;
  poller.run(milliseconds(2200), braking);
  poller.nothing(milliseconds(500));
  EXPECT_EQ(poller.run(seconds(1), braking).verdict, Verdict::believed);
}

TEST(JointGate, AnotherMotionOrALongGapIsNotBelieved) {
  for (const double off : {0.04, -0.04, 0.2, -3.0}) {
    Poller poller;
    poller.run(seconds(2), cruise);
    poller.nothing(milliseconds(500));
    poller.run(seconds(30), [off](double t) { return cruise(t) + off; });
    EXPECT_EQ(poller.believed, 0) << off;
  }
  Poller poller;
  poller.run(seconds(2), cruise);
  poller.nothing(milliseconds(1000));
  EXPECT_TRUE(poller.run(seconds(30), cruise).needs_edge);
  EXPECT_EQ(poller.believed, 0);
}

TEST(JointGate, AFrozenJointIsRefusedAndItsReturnBelieved) {
  Poller poller;
  poller.run(seconds(2), cruise);
  poller.stand(milliseconds(400), cruise(2.0));
  EXPECT_LE(poller.believed, 6) << "120 ms, 6 cm";
  poller.run(seconds(2), cruise);
  EXPECT_GT(poller.believed, 40) << "without anybody's help";
  poller.run(seconds(1), cruise);
  EXPECT_EQ(poller.believed, 50);
}

TEST(JointGate, AJointThatStaysFrozenIsNotBelieved) {
  Poller poller;
  poller.run(seconds(2), cruise);
  poller.stand(milliseconds(300), cruise(2.0));
  EXPECT_TRUE(poller.stand(seconds(60), cruise(2.0)).needs_edge);
  EXPECT_EQ(poller.believed, 0);
}

TEST(JointGate, APlcThatStartsColdWithAParkedMachineNeedsNobody) {
  Poller poller;
  poller.stand(seconds(10), 123.4);
  poller.nothing(seconds(40));
  poller.stand(seconds(2), 0.0);  // its program runs, its encoders do not
  EXPECT_EQ(poller.believed, 0);
  EXPECT_EQ(poller.stand(milliseconds(600), 123.4).verdict, Verdict::believed);
}

TEST(JointGate, AStartThatIsBrokenOffIsAStartAgain) {
  for (const bool edge : {false, true}) {
    Poller poller;
    if (edge) {
      poller.stand(seconds(1), 50.0);
      poller.gate().reacquire();
    }
    poller.stand(milliseconds(500), 10.0);
    poller.nothing(seconds(1));
    EXPECT_EQ(poller.travel(77.0).verdict, Verdict::believed);
    poller.stand(milliseconds(500), 77.0);
    poller.nothing(seconds(1));
    EXPECT_EQ(poller.travel(10.0).verdict, Verdict::on_trial) << "it had lasted";
  }
}

TEST(JointGate, WhatCameOutOfATrialIsNoStart) {
  Poller poller;
  poller.stand(seconds(1), 10.0);
  poller.nothing(seconds(1));
  ASSERT_EQ(poller.stand(milliseconds(280), 10.0).verdict, Verdict::believed);
  poller.nothing(seconds(1));
  poller.stand(seconds(5), 77.0);
  EXPECT_EQ(poller.believed, 0);
}

TEST(JointGate, ReacquireBelievesTheNextValueInRange) {
  Poller poller;
  poller.stand(seconds(1), 10.0);
  ASSERT_EQ(poller.travel(200.0).verdict, Verdict::refused);
  poller.gate().reacquire();
  EXPECT_EQ(poller.travel(600.0).verdict, Verdict::refused);
  EXPECT_EQ(poller.travel(200.0).verdict, Verdict::believed);
}

TEST(JointGate, WithoutACommandWordARestartIsTheEdge) {
  JointGateConfig mute = config();
  mute.has_command = false;
  Poller poller(mute);
  poller.stand(seconds(1), 10.0);
  EXPECT_THAT(poller.stand(seconds(2), 11.0).reason,
              HasSubstr("wait for a restart of the service, since plc.read.command is -1"));
}

TEST(JointGate, FramesThatTheQuayConfirmsEndATrial) {
  Poller poller;
  poller.stand(seconds(1), 10.0);
  poller.nothing(seconds(1));
  const MeasurementTime before = poller.now();
  poller.stand(seconds(2), 13.0);
  const auto frame = [&](Nanoseconds begin, bool confirmed) {
    poller.gate().frame_done(before + begin, before + begin + milliseconds(100), confirmed);
    return poller.stand(milliseconds(20), 13.0).verdict;
  };
  EXPECT_EQ(frame(milliseconds(0), true), Verdict::on_trial) << "begins before the trial";
  for (int i = 1; i <= 4; ++i) {
    EXPECT_EQ(frame(i * milliseconds(100), true), Verdict::on_trial) << i;
  }
  EXPECT_EQ(frame(milliseconds(500), false), Verdict::on_trial) << "the row is broken";
  for (int i = 6; i <= 9; ++i) {
    EXPECT_EQ(frame(i * milliseconds(100), true), Verdict::on_trial) << i;
  }
  EXPECT_EQ(frame(milliseconds(1000), true), Verdict::believed);
}

TEST(JointGate, ASampleIsBelievedAsAWholeOrNotAtAll) {
  Poller poller;
  for (int i = 0; i < 50; ++i) {
    poller.offer({0.0, 0.0, 0.0});
  }
  const auto outcome = poller.offer({0.0, 0.0, radians(45.0)});
  EXPECT_EQ(outcome.verdict, Verdict::refused);
  EXPECT_THAT(outcome.reason, HasSubstr("luff 45.000 deg"));
  EXPECT_EQ(poller.offer({0.0, 0.0, 0.0}).verdict, Verdict::believed);
}

}  // namespace
}  // namespace hulltrack
