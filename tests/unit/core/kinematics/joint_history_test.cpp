#include "core/kinematics/joint_history.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace hulltrack {
namespace {

MeasurementTime ms(int t) { return measurement_time_from_ns(std::int64_t{t} * 1'000'000); }

using Lookup = JointHistory::Lookup;

TEST(JointHistory, InterpolatesLinearlyBetweenSamples) {
  JointHistory history;
  ASSERT_TRUE(history.add({ms(100), {1.0, 0.1, -0.2}}));
  ASSERT_TRUE(history.add({ms(120), {2.0, 0.3, -0.4}}));
  const auto answer = history.at(ms(105));
  ASSERT_EQ(answer.lookup, Lookup::ok);
  EXPECT_DOUBLE_EQ(answer.joints.d_x, 1.25);
  EXPECT_DOUBLE_EQ(answer.joints.theta_r, 0.15);
  EXPECT_DOUBLE_EQ(answer.joints.theta_p, -0.25);
  EXPECT_DOUBLE_EQ(history.at(ms(100)).joints.d_x, 1.0);
  EXPECT_DOUBLE_EQ(history.at(ms(120)).joints.d_x, 2.0);
}

TEST(JointHistory, NeverHoldsOrExtrapolates) {
  JointHistory history;
  EXPECT_EQ(history.at(ms(0)).lookup, Lookup::empty);
  history.add({ms(100), {}});
  history.add({ms(120), {}});
  EXPECT_EQ(history.at(ms(99)).lookup, Lookup::before_oldest);
  EXPECT_EQ(history.at(ms(121)).lookup, Lookup::after_newest);
}

TEST(JointHistory, ABracketSpansAtMost250Milliseconds) {
  JointHistory history;
  history.add({ms(0), {}});
  history.add({ms(250), {}});
  history.add({ms(501), {}});
  EXPECT_EQ(history.at(ms(125)).lookup, Lookup::ok);
  EXPECT_EQ(history.at(ms(300)).lookup, Lookup::gap);
  EXPECT_EQ(history.covers(ms(10), ms(250)), Lookup::ok);
  EXPECT_EQ(history.covers(ms(10), ms(501)), Lookup::gap)
      << "a gap between two times that both have an answer";
  EXPECT_EQ(history.covers(ms(10), ms(502)), Lookup::after_newest);
  EXPECT_EQ(history.covers(ms(-1), ms(250)), Lookup::before_oldest);
}

void expect_rate(const JointHistory::State& motion, const Joints& rate, Nanoseconds spacing) {
  EXPECT_NEAR(motion.rate.d_x, rate.d_x, 1e-9);
  EXPECT_NEAR(motion.rate.theta_r, rate.theta_r, 1e-9);
  EXPECT_NEAR(motion.rate.theta_p, rate.theta_p, 1e-9);
  EXPECT_EQ(motion.spacing, spacing);
}

TEST(JointHistory, MotionIsThatBetweenTheSamplesAround) {
  JointHistory history;
  history.add({ms(100), {1.0, 0.1, -0.2}});
  history.add({ms(120), {2.0, 0.3, -0.4}});
  history.add({ms(160), {2.0, 0.1, 0.0}});
  const auto first = history.motion_at(ms(105));
  ASSERT_TRUE(first);
  EXPECT_DOUBLE_EQ(first->joints.d_x, 1.25);
  EXPECT_DOUBLE_EQ(first->joints.theta_r, 0.15);
  EXPECT_DOUBLE_EQ(first->joints.theta_p, -0.25);
  expect_rate(*first, {50.0, 10.0, -10.0}, std::chrono::milliseconds(20));
  const auto second = history.motion_at(ms(159));
  ASSERT_TRUE(second);
  expect_rate(*second, {0.0, -5.0, 10.0}, std::chrono::milliseconds(40));
}

TEST(JointHistory, MotionAtASampleIsThatAfterItAndAtTheNewestThatBefore) {
  JointHistory history;
  history.add({ms(100), {1.0, 0.0, 0.0}});
  history.add({ms(120), {2.0, 0.0, 0.0}});
  history.add({ms(160), {1.0, 0.0, 0.0}});
  for (const auto& [t, d_x, rate, spacing] :
       {std::tuple{100, 1.0, 50.0, 20}, {120, 2.0, -25.0, 40}, {160, 1.0, -25.0, 40}}) {
    const auto motion = history.motion_at(ms(t));
    ASSERT_TRUE(motion) << t;
    EXPECT_EQ(motion->joints.d_x, d_x) << t;
    expect_rate(*motion, {rate, 0.0, 0.0}, std::chrono::milliseconds(spacing));
  }
}

TEST(JointHistory, ThereIsNoMotionWhereThereIsNoAnswer) {
  JointHistory history;
  EXPECT_FALSE(history.motion_at(ms(0)));
  history.add({ms(0), {1.0, 0.0, 0.0}});
  EXPECT_FALSE(history.motion_at(ms(0))) << "one sample does not tell how it moves";
  history.add({ms(251), {2.0, 0.0, 0.0}});
  for (const int t : {-1, 100, 252}) {
    EXPECT_FALSE(history.motion_at(ms(t))) << t;
  }
}

TEST(JointHistory, AnAnswerIsOnTrialIfASampleBesideItIs) {
  JointHistory history;
  history.add({ms(0), {}});
  history.add({ms(20), {}});
  history.add({ms(40), {}, true});
  history.add({ms(60), {}});
  history.add({ms(80), {}});
  EXPECT_FALSE(history.on_trial(ms(0), ms(20)));
  EXPECT_TRUE(history.on_trial(ms(5), ms(21)));
  EXPECT_TRUE(history.on_trial(ms(25), ms(30)));
  EXPECT_TRUE(history.on_trial(ms(41), ms(50)));
  EXPECT_TRUE(history.on_trial(ms(0), ms(80)));
  EXPECT_FALSE(history.on_trial(ms(60), ms(80)));
  EXPECT_FALSE(history.on_trial(ms(61), ms(61)));
}

TEST(JointHistory, RefusesTimeThatDoesNotAdvance) {
  JointHistory history;
  EXPECT_TRUE(history.add({ms(100), {1.0, 0.0, 0.0}}));
  EXPECT_FALSE(history.add({ms(100), {9.0, 0.0, 0.0}}));
  EXPECT_FALSE(history.add({ms(50), {9.0, 0.0, 0.0}}));
  EXPECT_EQ(history.size(), 1U);
  EXPECT_DOUBLE_EQ(history.newest()->joints.d_x, 1.0);
}

TEST(JointHistory, KeepsTheNewestSamplesOnly) {
  JointHistory history(3);
  for (int i = 0; i < 10; ++i) {
    history.add({ms(20 * i), {static_cast<double>(i), 0.0, 0.0}});
  }
  EXPECT_EQ(history.size(), 3U);
  EXPECT_EQ(history.at(ms(130)).lookup, Lookup::before_oldest);
  EXPECT_DOUBLE_EQ(history.at(ms(150)).joints.d_x, 7.5);
}

}  // namespace
}  // namespace hulltrack
