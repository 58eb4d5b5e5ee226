#include "core/kinematics/joint_history.hpp"

#include <gtest/gtest.h>

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
