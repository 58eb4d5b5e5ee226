#include "daemon/simulator/run/live_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Contains;
using testing::HasSubstr;

/// What a perfect service writes at `time` about the scan 50 ms before, off by `error` m in x.
WriteBlock block(const SimulatedBerth& berth, Nanoseconds time, bool health, double error) {
  const ShipPose truth = berth.truth(time - milliseconds(50));
  WriteBlock b;
  b.health = health;
  b.state = health ? State::tracking : State::lost;
  b.age_ms = 50.0;
  b.x_m = truth.displacement.x() + error;
  b.y_m = truth.displacement.y();
  b.z_m = truth.displacement.z();
  b.roll_deg = degrees(truth.rpy.x());
  b.pitch_deg = degrees(truth.rpy.y());
  b.yaw_deg = degrees(truth.rpy.z());
  return b;
}

TEST(LiveJudge, SummaryCountsHealthErrorAndDeparture) {
  const auto berth = std::move(SimulatedBerth::create({.scenario = "berth", .seed = 4})).value();
  LiveJudge judge(*berth);
  judge.add(block(*berth, seconds(1), false, 0.0), seconds(1));
  for (int i = 2; i < 80; ++i)
    judge.add(block(*berth, seconds(i), i != 40, i == 30 ? 0.025 : 0.001), seconds(i));
  judge.add(block(*berth, milliseconds(82'000), true, 0.004), milliseconds(82'000));
  judge.add(block(*berth, milliseconds(82'100), false, 0.3), milliseconds(82'100));
  const auto lines = judge.summary(seconds(87));
  EXPECT_THAT(lines, Contains(HasSubstr("first healthy at 2.0 s; from then on healthy in 98.72 %")));
  EXPECT_THAT(lines, Contains(HasSubstr("worst healthy pose: 25.0 mm and 0.000 deg")));
  EXPECT_THAT(lines, Contains(HasSubstr("last health 1 came +2.0 s from then, 4.0 mm off")));
}

TEST(LiveJudge, SaysWhenTheServiceNeverWroteOrNeverWasHealthy) {
  const auto berth = std::move(SimulatedBerth::create({.scenario = "static", .seed = 4})).value();
  LiveJudge judge(*berth);
  EXPECT_THAT(judge.summary(seconds(5)), Contains(HasSubstr("never wrote")));
  EXPECT_THAT(judge.line(seconds(1)), HasSubstr("heard nothing yet"));
  judge.add(block(*berth, seconds(2), false, 0.0), seconds(2));
  EXPECT_THAT(judge.summary(seconds(5)), Contains(HasSubstr("never 1")));
  EXPECT_THAT(judge.line(seconds(2)), HasSubstr("lost"));
}

}  // namespace
}  // namespace hulltrack
