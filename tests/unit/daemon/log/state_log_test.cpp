#include "daemon/log/state_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/recording_log.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

WriteBlock block_of(State state, Faults faults = 0) {
  WriteBlock block;
  block.state = state;
  block.health = state == State::tracking;
  block.faults = faults;
  block.q1_m = 0.071;
  block.matched = 812;
  block.age_ms = 63.0;
  return block;
}

TEST(StateLog, WhatWaitsForAPersonDoesNotPromiseToReturnByItself) {
  RecordingLog log;
  StateLog states(log);
  states.update(block_of(State::degraded, fault::plc_value), "joint values wait for a re-acquire edge", {});
  EXPECT_THAT(log.last(), HasSubstr("joint values not believed; joint values wait for a re-acquire edge"));
  EXPECT_THAT(log.last(), HasSubstr("for as long as its joint values are not believed"));
  EXPECT_THAT(log.last(), Not(HasSubstr("returns by itself")));
}

TEST(StateLog, OneLineAChangeWithReasonAndFigures) {
  RecordingLog log;
  StateLog states(log);
  const SteadyTime start{};
  states.update(block_of(State::tracking), "", start);
  states.update(block_of(State::tracking), "", start + seconds(1));
  ASSERT_EQ(log.lines.size(), 1U);
  EXPECT_EQ(log.lines[0].level, LogLevel::notice);
  EXPECT_THAT(log.last(), HasSubstr("state tracking"));
  EXPECT_THAT(log.last(), HasSubstr("Q1 0.071 m, 812 points matched, pose 63 ms old"));
  EXPECT_THAT(log.last(), HasSubstr("health 1"));

  states.update(block_of(State::lost, fault::q1_high), "Q1 0.310 m is above 0.250 m", start + seconds(62));
  ASSERT_EQ(log.lines.size(), 2U);
  EXPECT_EQ(log.lines[1].level, LogLevel::warning);
  EXPECT_THAT(log.last(), HasSubstr("state lost after 62.0 s of tracking"));
  EXPECT_THAT(log.last(), HasSubstr("Q1 too high; Q1 0.310 m is above 0.250 m"));
  EXPECT_THAT(log.last(), HasSubstr("health 0"));
}

TEST(StateLog, APoseOnTheEdgeOfALimitDoesNotFillTheLog) {
  RecordingLog log;
  StateLog states(log);
  for (int frame = 0; frame < 600; ++frame) {
    const State state = frame % 2 == 0 ? State::tracking : State::degraded;
    states.update(block_of(state), "", SteadyTime{} + milliseconds(100) * frame);
  }
  EXPECT_LE(log.lines.size(), 2U * 6U) << "each of two states at most once in 10 s, for a minute";
  EXPECT_THAT(log.lines[2].text,
              HasSubstr("state tracking after 9.9 s of degraded and 98 changes in between"));
}

TEST(StateLog, TheLastWordIsTrueWithinTenSeconds) {
  RecordingLog log;
  StateLog states(log);
  states.update(block_of(State::tracking), "", SteadyTime{});
  states.update(block_of(State::lost), "", SteadyTime{} + seconds(1));
  states.update(block_of(State::tracking), "", SteadyTime{} + seconds(2));
  EXPECT_THAT(log.last(), HasSubstr("state lost"));
  states.update(block_of(State::tracking), "", SteadyTime{} + seconds(10));
  EXPECT_THAT(log.last(), HasSubstr("state tracking for 8.0 s, after 1.0 s of lost"));
}

TEST(StateLog, AStopIsAlwaysTold) {
  RecordingLog log;
  StateLog states(log);
  states.update(block_of(State::tracking), "", SteadyTime{});
  states.update(block_of(State::stopped), "", SteadyTime{} + milliseconds(1));
  EXPECT_THAT(log.last(), HasSubstr("state stopped"));
}

TEST(StateLog, NamesEveryFaultBit) {
  for (unsigned bit = 0; bit < 16; ++bit) {
    EXPECT_NE(fault_words(static_cast<Faults>(1u << bit)), "") << "bit " << bit;
  }
  EXPECT_EQ(fault_words(0), "");
  EXPECT_EQ(fault_words(fault::plc_stale | fault::lidar_silent), "PLC data stale, a LiDAR silent");
}

}  // namespace
}  // namespace hulltrack
