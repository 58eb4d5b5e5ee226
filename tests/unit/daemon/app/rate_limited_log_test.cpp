#include "daemon/app/rate_limited_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hulltrack {
namespace {

using ::testing::ElementsAre;

struct RecordingSink final : LogSink {
  void write(LogLevel, std::string_view line) override { lines.emplace_back(line); }
  std::vector<std::string> lines;
};

SteadyTime at(int seconds) { return SteadyTime{std::chrono::seconds(1000 + seconds)}; }

TEST(RateLimitedLog, LogsTheFirstLineAtOnceAndRepeatsEveryTenSecondsWithTheirCount) {
  RecordingSink sink;
  RateLimitedLog log(sink);
  for (int second = 0; second < 25; ++second) {
    log.write(LogLevel::warning, "loss", "lost " + std::to_string(second), at(second));
  }
  EXPECT_THAT(sink.lines, ElementsAre("lost 0", "lost 10 (10 times in the last 10 s)",
                                      "lost 20 (10 times in the last 10 s)"));
}

TEST(RateLimitedLog, FlushTellsTheRestOnceItIsDue) {
  RecordingSink sink;
  RateLimitedLog log(sink);
  for (const int second : {0, 1, 2}) {
    log.write(LogLevel::warning, "loss", "lost " + std::to_string(second), at(second));
  }
  log.flush(at(9));
  EXPECT_THAT(sink.lines, ElementsAre("lost 0"));
  log.flush(at(10));
  log.flush(at(30));
  EXPECT_THAT(sink.lines, ElementsAre("lost 0", "lost 2 (2 times in the last 10 s)"));
}

TEST(RateLimitedLog, AnEventAfterAQuietIntervalIsAFirstOneAgain) {
  RecordingSink sink;
  RateLimitedLog log(sink);
  log.write(LogLevel::warning, "loss", "one", at(0));
  log.flush(at(10));
  log.write(LogLevel::warning, "loss", "two", at(10));
  EXPECT_THAT(sink.lines, ElementsAre("one", "two"));
}

TEST(RateLimitedLog, KeysDoNotDisturbEachOther) {
  RecordingSink sink;
  RateLimitedLog log(sink);
  log.write(LogLevel::warning, "a", "a1", at(0));
  log.write(LogLevel::warning, "b", "b1", at(1));
  log.write(LogLevel::warning, "a", "a2", at(2));
  EXPECT_THAT(sink.lines, ElementsAre("a1", "b1"));
}

TEST(RateLimitedLog, ItsMemoryIsBounded) {
  RecordingSink sink;
  RateLimitedLog log(sink);
  for (int key = 0; key < 1000; ++key) {
    log.write(LogLevel::warning, "sender " + std::to_string(key), "line", at(0));
  }
  EXPECT_EQ(sink.lines.size(), RateLimitedLog::kMaxKeys + 1) << "the rest shares one event";
}

}  // namespace
}  // namespace hulltrack
