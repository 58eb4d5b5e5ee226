#include "daemon/log/queued_log.hpp"

#include <gtest/gtest.h>

#include <latch>
#include <mutex>
#include <string>
#include <vector>

namespace hulltrack {
namespace {

/// A log that takes nothing until it is told to go on. Shared with the queue's thread.
struct StuckLog {
  std::latch entered{1};
  std::latch released{1};
  std::mutex mutex;
  std::vector<std::string> lines;

  void take(std::string_view line) {
    if (!entered.try_wait()) {
      entered.count_down();
    }
    released.wait();
    const std::lock_guard lock(mutex);
    lines.emplace_back(line);
  }
};

constexpr Nanoseconds kForEver = std::chrono::hours(1);

TEST(QueuedLog, WritesEveryLineInOrderBeforeItIsGone) {
  std::vector<std::string> lines;
  {
    QueuedLog log([&](LogLevel, std::string_view line) { lines.emplace_back(line); }, 1000, kForEver);
    for (int i = 0; i < 100; ++i) {
      log.write(LogLevel::info, std::to_string(i));
    }
  }
  ASSERT_EQ(lines.size(), 100U);
  EXPECT_EQ(lines.front(), "0");
  EXPECT_EQ(lines.back(), "99");
}

TEST(QueuedLog, AFlushReturnsWhenEveryLineIsWritten) {
  std::mutex mutex;
  std::vector<std::string> lines;
  QueuedLog log(
      [&](LogLevel, std::string_view line) {
        const std::lock_guard lock(mutex);
        lines.emplace_back(line);
      },
      1000, kForEver);
  for (int i = 0; i < 100; ++i) {
    log.write(LogLevel::info, std::to_string(i));
  }
  log.flush();
  const std::lock_guard lock(mutex);
  EXPECT_EQ(lines.size(), 100U);
}

TEST(QueuedLog, AFlushOfAStuckLogRunsOutOfPatience) {
  auto stuck = std::make_shared<StuckLog>();
  QueuedLog log([stuck](LogLevel, std::string_view line) { stuck->take(line); }, 3,
                std::chrono::milliseconds(1));
  log.write(LogLevel::info, "first");
  log.flush();
  EXPECT_TRUE(stuck->lines.empty());
  stuck->released.count_down();
}

TEST(QueuedLog, NeverWaitsForAStuckLogAndReportsWhatItDropped) {
  auto stuck = std::make_shared<StuckLog>();
  {
    QueuedLog log([stuck](LogLevel, std::string_view line) { stuck->take(line); }, 3, kForEver);
    log.write(LogLevel::info, "first");
    stuck->entered.wait();  // "first" is with the stuck log, the queue is empty
    for (int i = 0; i < 10; ++i) {
      log.write(LogLevel::info, "line " + std::to_string(i));  // returns although nobody takes them
    }
    EXPECT_EQ(log.dropped(), 7U);
    stuck->released.count_down();
  }
  ASSERT_EQ(stuck->lines.size(), 5U);
  EXPECT_EQ(stuck->lines[1], "line 0");
  EXPECT_EQ(stuck->lines[2], "7 log lines were dropped because the system log did not take them");
  EXPECT_EQ(stuck->lines[4], "line 2");
}

TEST(QueuedLog, IsDestroyedThoughItsLogIsStuck) {
  auto stuck = std::make_shared<StuckLog>();
  {
    QueuedLog log([stuck](LogLevel, std::string_view line) { stuck->take(line); }, 3, Nanoseconds{0});
    log.write(LogLevel::info, "never taken");
    stuck->entered.wait();
  }
  stuck->released.count_down();  // lets the abandoned thread end
}

}  // namespace
}  // namespace hulltrack
