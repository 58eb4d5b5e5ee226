#include "daemon/app/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hulltrack {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

Figures one_good_second() {
  Figures figures;
  figures.frames = 10;
  figures.healthy_frames = 9;
  for (int frame = 0; frame < 10; ++frame) {
    figures.q1_m.add(0.071);
    figures.processing_ms.add(12.0);
    figures.latency_ms.add(frame == 0 ? 80.0 : 30.0);
  }
  figures.polls = 50;
  for (int poll = 0; poll < 50; ++poll) {
    figures.round_trip_ms.add(2.1);
  }
  figures.packets = 754;
  return figures;
}

WriteBlock tracking() {
  WriteBlock block;
  block.state = State::tracking;
  block.health = true;
  return block;
}

TEST(Summary, StatusLineReadsAsTheManualShowsIt) {
  EXPECT_EQ(status_line(tracking(), one_good_second(), seconds(1)),
            "tracking 10.0 Hz, Q1 0.071 m, PLC 2.1 ms, loss 0.0 %");
}

TEST(Summary, StatusLineNamesWhatIsMissing) {
  WriteBlock block;
  block.state = State::fault;
  block.faults = fault::plc_stale | fault::lidar_silent;
  EXPECT_EQ(status_line(block, {}, seconds(1)), "fault 0.0 Hz, no Q1, PLC down, loss 0.0 %, LiDAR silent");
}

TEST(Summary, StatusLineTellsThatThePlcRefusesOurRegisters) {
  Figures figures = one_good_second();
  figures.writes_failed = 10;
  EXPECT_THAT(status_line(tracking(), figures, seconds(1)), HasSubstr("PLC 2.1 ms but writes fail"));
}

TEST(Summary, SixtySecondsAddUpToAMinute) {
  Figures minute;
  for (int second = 0; second < 60; ++second) {
    minute.add(one_good_second());
  }
  const std::string line = summary_line(tracking(), minute, seconds(60));
  EXPECT_THAT(line,
              HasSubstr("600 frames (10.0 Hz), health 1 in 90.0 %, Q1 0.071 m, latency 35 ms (worst 80)"));
  EXPECT_THAT(line, HasSubstr("0 of 3000 polls"));
  EXPECT_THAT(line, HasSubstr("45240 packets"));
}

TEST(FigureBoard, AWindowStartsEmptyAfterItWasTaken) {
  FigureBoard board;
  board.add(one_good_second());
  EXPECT_EQ(board.take().frames, 10U);
  EXPECT_EQ(board.take().frames, 0U);
}

}  // namespace
}  // namespace hulltrack
