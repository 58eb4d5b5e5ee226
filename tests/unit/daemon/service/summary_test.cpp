#include "daemon/service/summary.hpp"

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

TEST(Summary, StatusLineTellsThatJointValuesAreNotBelieved) {
  WriteBlock block = tracking();
  block.faults = fault::plc_value;
  EXPECT_THAT(status_line(block, one_good_second(), seconds(1)),
              HasSubstr("PLC 2.1 ms but its joint values not believed"));
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

const SteadyTime kNow{seconds(1000)};

HullFigures loading() {
  HullFigures hull;
  hull.when = kNow - std::chrono::milliseconds(200);
  hull.motion.now = ShipMotion{1.324, radians(0.52), radians(-0.30), 0.05};
  hull.motion.rate = ShipMotion{1.07 / 3600, radians(-0.10) / 3600, radians(-0.2) / 3600, -0.25 / 60};
  hull.motion.mapped_length = 120.0;
  return hull;
}

TEST(HullLine, SaysWhichSideAndEndIsDownAndWhetherThatGrows) {
  EXPECT_EQ(
      hull_line(loading(), kNow),
      "hull since its map: 1.32 m deeper, sinking 1.1 m/h; heel 0.52 deg, -Y side down, easing 0.1 deg/h; "
      "trim 0.30 deg (0.63 m over 120 m), -X end down, growing 0.2 deg/h; surge +0.05 m, -0.25 m/min");
}

TEST(HullLine, NamesTheOppositesToo) {
  HullFigures hull = loading();
  hull.motion.now = ShipMotion{-0.4, radians(-0.5), radians(0.3), -0.05};
  hull.motion.rate->draft = -0.5 / 3600;
  const std::string line = hull_line(hull, kNow);
  EXPECT_THAT(line, HasSubstr("0.40 m higher, rising 0.5 m/h"));
  EXPECT_THAT(line, HasSubstr("heel 0.50 deg, +Y side down, growing"));
  EXPECT_THAT(line, HasSubstr("+X end down, easing"));
}

TEST(HullLine, ARateThatRoundsToNothingIsSteady) {
  HullFigures hull = loading();
  hull.motion.rate = ShipMotion{-0.04 / 3600, radians(0.04) / 3600, 0.0, 0.0};
  EXPECT_EQ(hull_line(hull, kNow),
            "hull since its map: 1.32 m deeper, steady; heel 0.52 deg, -Y side down, steady; "
            "trim 0.30 deg (0.63 m over 120 m), -X end down, steady; surge +0.05 m, +0.00 m/min");
}

TEST(HullLine, WhatIsUnknownIsSaid) {
  EXPECT_THAT(hull_line(std::nullopt, kNow), HasSubstr("no healthy pose"));
  HullFigures hull = loading();
  hull.motion.rate.reset();
  const std::string line = hull_line(hull, kNow);
  EXPECT_THAT(line, HasSubstr("deeper; heel 0.52 deg, -Y side down; trim"));
  EXPECT_THAT(line, HasSubstr("surge +0.05 m; rates not known yet"));
}

TEST(HullLine, BendIsThereOnceItIsKnown) {
  HullFigures hull = loading();
  EXPECT_EQ(hull_line(hull, kNow).find("sag"), std::string::npos);
  hull.bend = 0.08;
  hull.sigma_bend = 0.02;
  EXPECT_THAT(hull_line(hull, kNow), HasSubstr("; sag 0.08 m (1 sigma 0.02 m)"));
  hull.bend = -0.08;
  EXPECT_THAT(hull_line(hull, kNow), HasSubstr("; hog 0.08 m"));
}

TEST(HullLine, AnOldPoseTellsItsAge) {
  EXPECT_THAT(hull_line(loading(), kNow + seconds(40)),
              HasSubstr("as it lay 40 s ago when health was last 1"));
}

TEST(Figures, TheNewestHullOfAWindowIsKept) {
  Figures minute;
  Figures second = one_good_second();
  second.hull = loading();
  minute.add(second);
  second.hull->when = kNow;
  minute.add(second);
  minute.add(one_good_second());  // no healthy pose in it
  EXPECT_EQ(minute.hull->when, kNow);
}

TEST(FigureBoard, AWindowStartsEmptyAfterItWasTaken) {
  FigureBoard board;
  board.add(one_good_second());
  EXPECT_EQ(board.take().frames, 10U);
  EXPECT_EQ(board.take().frames, 0U);
}

}  // namespace
}  // namespace hulltrack
