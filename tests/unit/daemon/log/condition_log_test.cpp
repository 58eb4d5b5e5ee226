#include "daemon/log/condition_log.hpp"

#include <gtest/gtest.h>

#include "tests/support/recording_log.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class ConditionLogTest : public testing::Test {
 protected:
  void tell(bool active, Nanoseconds t) {
    condition.update(
        active, SteadyTime{} + t, [] { return std::string("begins"); },
        [](Nanoseconds lasted) { return "ends after " + std::to_string(lasted / milliseconds(1)) + " ms"; });
  }

  RecordingLog log;
  ConditionLog condition{log};
};

TEST_F(ConditionLogTest, OneLineOnEntryAndOneOnExit) {
  tell(false, seconds(0));
  tell(true, seconds(1));
  tell(true, seconds(2));
  tell(true, seconds(60));
  tell(false, seconds(61));
  tell(false, seconds(62));
  ASSERT_EQ(log.lines.size(), 2U);
  EXPECT_EQ(log.lines[0].text, "begins");
  EXPECT_EQ(log.lines[0].level, LogLevel::warning);
  EXPECT_EQ(log.lines[1].text, "ends after 60000 ms");
  EXPECT_EQ(log.lines[1].level, LogLevel::notice);
}

TEST_F(ConditionLogTest, AFlappingConditionIsToldAtMostOnceInTenSecondsWithACount) {
  for (int second = 0; second < 60; ++second) {
    tell(true, seconds(second));
    tell(false, seconds(second) + milliseconds(500));
  }
  std::size_t entries = 0;
  for (const auto& line : log.lines) {
    entries += line.text.rfind("begins", 0) == 0 ? 1 : 0;
  }
  EXPECT_EQ(entries, 6U);
  EXPECT_EQ(log.lines.size(), 12U) << "every entry line has its exit line";
  EXPECT_EQ(log.lines[2].text, "begins (and 9 more times since the last such line)");
}

TEST_F(ConditionLogTest, AnEpisodeThatWasHeldBackIsToldWhenItLasts) {
  tell(true, seconds(0));
  tell(false, seconds(1));
  tell(true, seconds(2));
  EXPECT_EQ(log.last(), "ends after 1000 ms");
  tell(true, milliseconds(9999));
  EXPECT_EQ(log.last(), "ends after 1000 ms");
  tell(true, seconds(10));
  EXPECT_EQ(log.last(), "begins");
  tell(false, seconds(11));
  EXPECT_EQ(log.last(), "ends after 9000 ms");
}

TEST(RecentGrowth, HoldsForTwoSecondsAfterTheCounterGrew) {
  RecentGrowth growth;
  EXPECT_FALSE(growth.update(0, SteadyTime{} + seconds(0)));
  EXPECT_TRUE(growth.update(3, SteadyTime{} + seconds(1)));
  EXPECT_TRUE(growth.update(3, SteadyTime{} + milliseconds(2999)));
  EXPECT_FALSE(growth.update(3, SteadyTime{} + seconds(3)));
  EXPECT_TRUE(growth.update(4, SteadyTime{} + seconds(3)));
}

}  // namespace
}  // namespace hulltrack
