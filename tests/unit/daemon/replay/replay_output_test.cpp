#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "daemon/replay/frame_csv.hpp"
#include "daemon/replay/joint_csv.hpp"
#include "daemon/replay/reason_table.hpp"
#include "daemon/replay/replay_summary.hpp"

namespace hulltrack {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TrackResult result(std::uint32_t frame, double x, State state) {
  TrackResult r;
  r.frame = frame;
  r.time = MeasurementTime{std::chrono::milliseconds(50 + 100 * frame)};
  r.registered = true;
  r.pose.T_W_H.translation() = Eigen::Vector3d(x, 0.0, 0.0);
  r.state = state;
  r.health = state == State::tracking;
  r.metrics = {true, 0.07, 0.08, 0.09, 0.1, 0.125, 1000};
  r.matched = 900;
  r.iterations = 4;
  return r;
}

/// The text of each column of a line, by the names of the header.
std::map<std::string, std::string> columns(const std::string& line) {
  std::istringstream names(kFrameCsvHeader);
  std::istringstream values(line + ',');
  std::map<std::string, std::string> fields;
  for (std::string name; std::getline(names, name, ',');) {
    EXPECT_TRUE(std::getline(values, fields[name], ',')) << "no " << name << " in " << line;
  }
  std::string more;
  EXPECT_FALSE(std::getline(values, more, ',')) << more << " after the last field of " << line;
  return fields;
}

TEST(FrameCsv, LineBeginsWithTheFieldsThatItAlwaysHad) {
  EXPECT_THAT(frame_csv_line(result(3, 0.1, State::tracking), 1.5),
              StartsWith("3,350000000,1,1,0,0.1,0,0,0,0,0,0.07,0.08,0.09,0.1,0.125,900,-1,-1,4,1.5,"));
}

TEST(FrameCsv, WhatIsUnknownIsEmpty) {
  TrackResult not_registered;
  not_registered.state = State::fault;
  not_registered.faults = fault::plc_stale;
  const std::string line = frame_csv_line(not_registered, std::nullopt);
  EXPECT_EQ(line, "0,0,5,0,2,,,,,,,,,,,,0,-1,-1,0," + std::string(10 + 21 + 1 + 1, ','));
  EXPECT_EQ(columns(line).size(), 21U + 10U + 21U + 1U + 1U);
  TrackResult sigma_alone = result(3, 0.1, State::tracking);
  sigma_alone.sigma_translation = 0.01;
  EXPECT_EQ(columns(frame_csv_line(sigma_alone, 1.5))["c_rx_rx"], "") << "nobody's covariance is zero";
}

TEST(FrameCsv, WhatQ1ShouldBeComesAfterTheCovariance) {
  TrackResult r = result(3, 0.1, State::tracking);
  EXPECT_EQ(columns(frame_csv_line(r, 1.5))["q1_expected"], "");
  r.metrics.q1_expected = 0.0625;
  const std::string line = frame_csv_line(r, 1.5);
  EXPECT_EQ(columns(line)["q1_expected"], "0.0625");
  EXPECT_THAT(line, ::testing::EndsWith(",0.0625,"));
}

TEST(FrameCsv, TheReasonForAHealthOf0ComesLastAndQuoted) {
  TrackResult r = result(3, 0.1, State::lost);
  r.reason = "Q1 is 0.31 m, \"lost\" above 0.30 m\nor more";
  EXPECT_THAT(frame_csv_line(r, 1.5),
              ::testing::EndsWith(",\"Q1 is 0.31 m, \"\"lost\"\" above 0.30 m or more\""));
  r = result(3, 0.1, State::tracking);
  r.reason = "nobody asks";
  EXPECT_THAT(frame_csv_line(r, 1.5), ::testing::EndsWith(","));
}

TEST(JointCsv, AJointThatTheQuayDoesNotShowIsEmpty) {
  TrackResult r = result(3, 0.1, State::tracking);
  EXPECT_EQ(joint_csv_line(r), "3,350000000,,,0,,,0,,,0");
  r.joint_doubts[0] = {.reads_too_much = -0.25, .hidden = 0.125, .finds_large = true};
  r.joint_doubts[2] = {.reads_too_much = radians(2.0), .hidden = radians(0.5)};
  EXPECT_EQ(joint_csv_line(r), "3,350000000,-0.25,0.125,1,,,0,2,0.5,0");
}

TEST(ReplaySummaryText, TellsTheQuaysTopThatWasFoundAsKeysToPaste) {
  ReplaySummary summary({}, 0.3);
  TrackResult r = result(1, 0.0, State::tracking);
  summary.add(r, 1.0);
  EXPECT_THAT(summary.text(false), Not(HasSubstr("quay's top")));
  r.found_top = SeenTop{{-0.15, {radians(0.5), radians(-1.0)}}, {}, Eigen::Vector3d::Zero(), 0.001};
  summary.add(r, 1.0);
  r.found_top.reset();  // a frame that was not looked at
  summary.add(r, 1.0);
  EXPECT_THAT(summary.text(false), HasSubstr("height = -0.150, slope = [0.50, -1.00]"));
}

TEST(FrameCsv, MotionHasTheUnitsOfTheOperator) {
  TrackResult r = result(3, 0.1, State::tracking);
  r.motion.now = ShipMotion{1.25, radians(0.5), radians(-0.25), -0.125};
  r.motion.rate = ShipMotion{1.0 / 3600.0, radians(2.0) / 3600.0, radians(-4.0) / 3600.0, 0.125};
  auto fields = columns(frame_csv_line(r, 1.5));
  EXPECT_EQ(fields["draft"], "1.25");
  EXPECT_NEAR(std::stod(fields["heel"]), 0.5, 1e-12);
  EXPECT_NEAR(std::stod(fields["trim"]), -0.25, 1e-12);
  EXPECT_EQ(fields["surge"], "-0.125");
  EXPECT_NEAR(std::stod(fields["draft_rate"]), 1.0, 1e-12);
  EXPECT_NEAR(std::stod(fields["heel_rate"]), 2.0, 1e-12);
  EXPECT_NEAR(std::stod(fields["trim_rate"]), -4.0, 1e-12);
  EXPECT_EQ(fields["surge_rate"], "7.5");
  EXPECT_EQ(fields["bend"] + fields["sigma_bend"] + fields["c_rx_rx"], "");
}

TEST(FrameCsv, CovarianceAndBendStandUnderTheirNames) {
  TrackResult r = result(3, 0.1, State::tracking);
  r.sigma_translation = 0.01;
  r.bend = -0.0625;
  r.sigma_bend = 0.03125;
  const std::array<std::string, 6> names{"rx", "ry", "rz", "x", "y", "z"};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      r.covariance(i, j) = 10 * std::min(i, j) + std::max(i, j);
    }
  }
  auto fields = columns(frame_csv_line(r, std::nullopt));
  EXPECT_EQ(fields["ms"], "");
  EXPECT_EQ(fields["bend"], "-0.0625");
  EXPECT_EQ(fields["sigma_bend"], "0.03125");
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = i; j < 6; ++j) {
      const std::string name = "c_" + names[i] + "_" + names[j];
      ASSERT_TRUE(fields.contains(name)) << name;
      EXPECT_EQ(fields[name], std::to_string(10 * i + j)) << name;
    }
  }
}

TEST(TruthAt, InterpolatesInsideAndIsSilentOutside) {
  const std::vector<TruthRow> truth{{100, {0, 0, 0}, {0, 0, 0}}, {200, {1, 2, 3}, {0, 0, 10}}};
  EXPECT_FALSE(truth_at(truth, 99));
  EXPECT_FALSE(truth_at(truth, 201));
  EXPECT_TRUE(truth_at(truth, 100)->xyz.isZero());
  EXPECT_TRUE(truth_at(truth, 125)->xyz.isApprox(Eigen::Vector3d(0.25, 0.5, 0.75)));
  EXPECT_DOUBLE_EQ(truth_at(truth, 125)->rpy_deg.z(), 2.5);
}

/// A hull at rest for 3 s, then 0.5 m/s along x.
std::vector<TruthRow> departing_truth() {
  std::vector<TruthRow> truth;
  for (int i = 0; i <= 600; ++i) {
    const double t = 0.01 * i;
    truth.push_back({i * 10'000'000LL, {0.5 * std::max(0.0, t - 3.0), 0, 0}, {0, 0, 0}});
  }
  return truth;
}

TEST(ReplaySummary, CountsWrongHealthyFramesAndTheReaction) {
  ReplaySummary summary(departing_truth(), 0.3);
  for (std::uint32_t frame = 0; frame < 60; ++frame) {
    // Stays healthy at x = 0 until frame 34, 0.45 s after the hull began to move.
    summary.add(result(frame, 0.0, frame <= 34 ? State::tracking : State::lost), 2.0);
  }
  const std::string text = summary.text(true);
  EXPECT_THAT(text, HasSubstr("frames      60"));
  EXPECT_THAT(text, HasSubstr("tracking 35 lost 25"));
  EXPECT_THAT(text, HasSubstr("max 0.225 m of 35 healthy frames"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "wrong       4 healthy frames off by more than 0.05 m or 0.1 deg; gross, 0.10 m or 0.3 deg: 3\n"))
      << text;  // 0.075, 0.125, 0.175, 0.225
  EXPECT_THAT(text, HasSubstr("frame 32: the pose is off by 0.10 m; health 0 after 0.3 s")) << text;
  EXPECT_THAT(text, HasSubstr("median 2.0 ms"));
  EXPECT_EQ(summary.text(false).find(" ms"), std::string::npos);
}

TEST(ReplaySummary, WhatQ1ShouldBeStandsBesideIt) {
  ReplaySummary summary({}, 0.3);
  TrackResult r = result(0, 0.0, State::tracking);
  summary.add(r, 1.0);
  EXPECT_THAT(summary.text(false), HasSubstr("Q1          median 0.070 m, 99 % 0.070 m\n"));
  r.metrics.q1_expected = 0.0625;
  summary.add(r, 1.0);
  EXPECT_THAT(summary.text(false),
              HasSubstr("Q1          median 0.070 m, 99 % 0.070 m; expected median 0.062 m, 99 % 0.062 m\n"));
}

TEST(ReplaySummary, ReasonsStandBehindTheStates) {
  ReplaySummary summary({}, 0.3);
  TrackResult r = result(0, 0.0, State::lost);
  r.reason = "Q1 is 0.31 m";
  summary.add(r, 1.0);
  summary.add(result(1, 0.0, State::tracking), 1.0);
  EXPECT_THAT(summary.text(false),
              HasSubstr(" %\nhealth 0     50.00 %, first in frame 0: Q1 is 0.31 m\nQ1  "));
}

TEST(ReasonTable, ReasonsThatDifferInTheirFiguresAreOneKind) {
  ReasonTable table;
  table.add(7, "the hull seems to heel by -1.5 deg of 3, hull.max_heel");
  table.add(8, "a LiDAR is silent");
  table.add(9, "the hull seems to heel by 12 deg of 3, hull.max_heel");
  EXPECT_EQ(table.text(10),
            "health 0     20.00 %, first in frame 7: the hull seems to heel by -1.5 deg of 3, hull.max_heel\n"
            "             10.00 %, first in frame 8: a LiDAR is silent\n");
}

TEST(ReasonTable, NamesWithDigitsAreNoFigures) {
  ReasonTable table;
  table.add(0, "Q1 is high");
  table.add(1, "Q3 is high");
  EXPECT_THAT(table.text(2), HasSubstr("Q3 is high"));
}

TEST(ReasonTable, WithoutFramesThereIsNothingToSay) { EXPECT_EQ(ReasonTable().text(10), ""); }

TEST(ReasonTable, AHundredKindsDoNotFillTheScreen) {
  ReasonTable table;
  for (std::uint32_t i = 0; i < 100; ++i) {
    table.add(i, std::string(i + 1, 'x'));
  }
  const std::string text = table.text(100);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 13);
  EXPECT_THAT(text, HasSubstr("  88.00 % for 88 other reasons\n"));
}

TEST(ReplaySummary, WithoutTruthThereAreNoErrors) {
  ReplaySummary summary({}, 0.3);
  summary.add(result(0, 0.0, State::tracking), 1.0);
  EXPECT_EQ(summary.text(true).find("error"), std::string::npos);
}

}  // namespace
}  // namespace hulltrack
