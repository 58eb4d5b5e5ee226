#include "daemon/service/progress_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/recording_log.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

class ProgressLogTest : public testing::Test {
 protected:
  void look(Nanoseconds t) { progress.update(watch.overdue(SteadyTime{} + t), SteadyTime{} + t); }
  static SteadyTime at(Nanoseconds t) { return SteadyTime{} + t; }

  RecordingLog log;
  ThreadWatch watch;
  Pulse& rx = watch.add("rx", milliseconds(500), at(milliseconds(0)));
  Pulse& track = watch.add("track", milliseconds(500), at(milliseconds(0)));
  ProgressLog progress{log, seconds(1)};
};

TEST_F(ProgressLogTest, NamesTheThreadItsSilenceAndWhatFollowsAndSaysOnceThatItGoesOn) {
  for (int step = 0; step <= 50; ++step) {  // five seconds; track is silent from 1 s to 2.5 s
    const Nanoseconds t = milliseconds(100) * step;
    rx.beat(at(t));
    if (t <= seconds(1) || t > milliseconds(2500)) {
      track.beat(at(t));
    }
    look(t);
  }
  ASSERT_EQ(log.lines.size(), 2U);
  EXPECT_EQ(log.lines[0].level, LogLevel::error);
  EXPECT_THAT(log.lines[0].text, HasSubstr("thread track has made no progress for 0.6 s"));
  EXPECT_THAT(log.lines[0].text, HasSubstr("the watchdog is not fed"));
  EXPECT_THAT(log.lines[0].text, HasSubstr("systemd restarts the service 1.0 s after the last feeding"));
  EXPECT_EQ(log.lines[1].level, LogLevel::notice);
  EXPECT_EQ(log.lines[1].text, "thread track makes progress again after 1.5 s");
}

TEST_F(ProgressLogTest, AThreadThatRelapsesIsToldAtMostOnceInTenSecondsWithACount) {
  for (int step = 0; step < 600; ++step) {  // a minute; a beat every 0.7 s
    const Nanoseconds t = milliseconds(100) * step;
    rx.beat(at(t));
    if (step % 7 == 0) {
      track.beat(at(t));
    }
    look(t);
  }
  EXPECT_EQ(log.count("thread track has made no progress"), 6U);
  EXPECT_EQ(log.count("thread track makes progress again"), 6U) << "every line has its end";
  EXPECT_EQ(log.lines.size(), 12U);
  EXPECT_EQ(log.count("more times since the last such line"), 5U) << "what was held back is counted";
}

TEST_F(ProgressLogTest, EveryThreadIsToldByItself) {
  look(milliseconds(600));
  EXPECT_EQ(log.count("thread rx has made no progress"), 1U);
  EXPECT_EQ(log.count("thread track has made no progress"), 1U);
  rx.beat(at(milliseconds(700)));
  look(milliseconds(700));
  EXPECT_EQ(log.last(), "thread rx makes progress again after 0.6 s");
  EXPECT_EQ(log.lines.size(), 3U);
}

TEST_F(ProgressLogTest, PromisesNoRestartWhereNobodyWatches) {
  ProgressLog unwatched(log, std::nullopt);
  unwatched.update(watch.overdue(at(seconds(1))), at(seconds(1)));
  EXPECT_THAT(log.last(), HasSubstr("nobody restarts the service"));
}

}  // namespace
}  // namespace hulltrack
