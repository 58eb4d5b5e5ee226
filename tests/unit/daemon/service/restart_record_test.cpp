// When the service waits before it tries again: only after failures in a row, and never for long.
#include "daemon/service/restart_record.hpp"

#include <gtest/gtest.h>

#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

using std::chrono::seconds;

TEST(RestartPause, ComesAfterThreeFailuresAndGrowsToAMinute) {
  for (const int failures : {0, 1, 2, 3}) {
    EXPECT_EQ(restart_pause(failures), seconds(0)) << failures;
  }
  EXPECT_EQ(restart_pause(4), seconds(1));
  EXPECT_EQ(restart_pause(5), seconds(2));
  EXPECT_EQ(restart_pause(9), seconds(32));
  for (const int failures : {10, 11, 1000, 1'000'000}) {
    EXPECT_EQ(restart_pause(failures), kLongestPause) << failures;
  }
}

class RestartRecordTest : public testing::Test {
 protected:
  [[nodiscard]] RestartRecord::Verdict start() const { return RestartRecord(folder.path()).begin(); }
  test::TempFolder folder;
};

TEST_F(RestartRecordTest, CountsEveryStartAfterWhichNothingWasSaid) {
  EXPECT_EQ(start().failures, 0);
  EXPECT_EQ(start().failures, 1);
  EXPECT_EQ(start().failures, 2);
  EXPECT_EQ(start().pause, seconds(0));
  EXPECT_EQ(start().pause, seconds(1));
}

TEST_F(RestartRecordTest, AnEndThatWasAskedForIsNoFailure) {
  for (int i = 0; i < 10; ++i) {
    RestartRecord record(folder.path());
    EXPECT_EQ(record.begin().failures, 0);
    record.end();
  }
}

TEST_F(RestartRecordTest, AfterAGoodSpellTheNextFailureIsTheFirst) {
  for (int i = 0; i < 10; ++i) {
    static_cast<void>(start());
  }
  RestartRecord record(folder.path());
  static_cast<void>(record.begin());
  record.forget();
  EXPECT_EQ(start().failures, 1);
}

TEST_F(RestartRecordTest, TellsTheLastEndInOneLine) {
  EXPECT_EQ(start().last_end, "");
  static_cast<void>(folder.file("last-end", "signal killed SEGV\nmore\n"));
  EXPECT_EQ(start().last_end, "signal killed SEGV");
}

TEST_F(RestartRecordTest, WhateverTheFilesHoldThePauseIsBounded) {
  for (const char* text : {"", "\n", "x", "-5", "99999999999999999999", "1000000000", "3 4", "\xff\xfe"}) {
    static_cast<void>(folder.file("failures", text));
    static_cast<void>(folder.file("last-end", text));
    const auto verdict = start();
    EXPECT_GE(verdict.failures, 1) << text;
    EXPECT_LE(verdict.pause, kLongestPause) << text;
  }
}

TEST(RestartRecord, WithoutAMemoryThereIsNoPause) {
  for (const std::optional<std::filesystem::path>& folder :
       {std::optional<std::filesystem::path>(),
        std::optional<std::filesystem::path>("/nonexistent/folder")}) {
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(RestartRecord(folder).begin().pause, seconds(0));
    }
  }
}

}  // namespace
}  // namespace hulltrack
