// Which frame is a point in, and when is a frame finished? Against streams whose firings are known one by
// one.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "lidar_drivers/scan_builder.hpp"
#include "tests/support/scan_building.hpp"
#include "tests/support/velodyne_bytes.hpp"
#include "tests/support/velodyne_stream.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::build;
using test::builder_for;
using test::expect_consistent;
using test::firing_times;
using test::lidar;
using test::point_times;
using test::take_all;

/// What of `stream` must be in `scans`: everything, but with revolution framing for the unfinished last turn.
std::vector<std::int64_t> framed_times(const test::VelodyneStream& stream, const std::vector<Scan>& scans,
                                       Framing framing) {
  std::vector<std::int64_t> times = firing_times(stream);
  if (framing == Framing::revolution) {
    std::erase_if(times, [&](std::int64_t time) { return time >= to_ns(scans.back().end); });
  }
  return times;
}

TEST(Framing, EveryPointIsInExactlyOneFrameAtItsFiringTime) {
  for (const char* model : {"velodyne_vlp16", "velodyne_vlp32c"}) {
    for (const Framing framing : {Framing::period, Framing::revolution}) {
      test::StreamOptions options{.model = model, .packets = 1000};
      options.encoder.start_azimuth = 1.0;
      const auto stream = test::make_stream(options);
      auto builder = builder_for({lidar(model)}, framing);
      const auto scans = build(builder, stream.packets);
      EXPECT_GT(scans.size(), 5U);
      EXPECT_EQ(point_times(scans), framed_times(stream, scans, framing));
      for (const Scan& scan : scans) expect_consistent(scan);
      EXPECT_EQ(builder.status(0).points_late, 0U);
      EXPECT_EQ(builder.status(0).packets_lost, 0U);
    }
  }
}

TEST(Framing, PeriodsFormOneGridFromTheFirstFiring) {
  const auto stream = test::make_stream({.packets = 800});
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  const MeasurementTime start = test::StreamOptions{}.start;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    EXPECT_EQ(scans[k].frame_number, k);
    EXPECT_EQ(scans[k].begin, start + k * milliseconds(100));
    EXPECT_EQ(scans[k].end, start + (k + 1) * milliseconds(100));
  }
}

TEST(Framing, ABoundaryInsideADatagramSplitsIt) {
  const auto stream = test::make_stream({.packets = 200});
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  ASSERT_GE(scans.size(), 2U);
  // 100 ms is no multiple of the 1.327104 ms between datagrams: the last one of frame 0 is in frame 1 too.
  EXPECT_EQ(scans[0].lidars[0].packets, 76U);
  EXPECT_LT(scans[0].segments.back().count, scans[0].segments[0].count);
  EXPECT_LT(scans[1].first_firing - scans[1].begin, std::chrono::microseconds(60));
}

TEST(Framing, NumbersSkipFramesInWhichNothingArrived) {
  auto stream = test::make_stream({.packets = 400});
  const MeasurementTime start = stream.packets.front().last_firing;
  std::erase_if(stream.packets, [&](const test::StreamPacket& p) {
    return p.last_firing > start + milliseconds(90) && p.last_firing < start + milliseconds(320);
  });
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans[0].frame_number, 0U);
  EXPECT_EQ(scans[1].frame_number, 3U);
  EXPECT_EQ(scans[2].frame_number, 4U);
}

TEST(Framing, RevolutionsEndWhereTheRotorPassesZero) {
  test::StreamOptions options{.packets = 1000};
  options.encoder.rpm = 600;
  options.encoder.start_azimuth = std::numbers::pi;
  const auto stream = test::make_stream(options);
  auto builder = builder_for({lidar()}, Framing::revolution);
  const auto scans = build(builder, stream.packets);
  ASSERT_GT(scans.size(), 10U);
  for (std::size_t k = 1; k < scans.size(); ++k) {
    // At 600 rpm from 180 deg on: zero after 50 ms, then every 100 ms. Azimuths are rounded to 0.01 deg = 2.8
    // us.
    const MeasurementTime expected = options.start + milliseconds(50) + (k - 1) * milliseconds(100);
    EXPECT_NEAR(to_milliseconds(scans[k].begin - expected), 0.0, 0.006);
    EXPECT_NEAR(to_milliseconds(scans[k].end - scans[k].begin), 100.0, 0.012);
  }
}

TEST(Framing, AnUnfinishedLastTurnIsNoFrame) {
  test::StreamOptions options{.packets = 1000};
  options.encoder.start_azimuth = std::numbers::pi;
  const auto stream = test::make_stream(options);
  auto builder = builder_for({lidar()}, Framing::revolution);
  const auto scans = build(builder, stream.packets);
  const MeasurementTime end = stream.packets.back().last_firing;
  EXPECT_GT(end, scans.back().end);
  EXPECT_LT(end - scans.back().end, milliseconds(100)) << "but every whole turn is one";

  const auto short_stream = test::make_stream({.packets = 40});
  auto short_builder = builder_for({lidar()}, Framing::revolution);
  EXPECT_TRUE(build(short_builder, short_stream.packets).empty());
}

TEST(Framing, AWrongRotationRateIsReportedAndFramesStayWhole) {
  for (const double rpm : {300.0, 1200.0}) {
    test::StreamOptions options{.packets = 1500};
    options.encoder.rpm = rpm;
    const auto stream = test::make_stream(options);
    for (const Framing framing : {Framing::period, Framing::revolution}) {
      auto builder = builder_for({lidar()}, framing);
      const auto scans = build(builder, stream.packets);
      EXPECT_EQ(point_times(scans), framed_times(stream, scans, framing));
      EXPECT_NEAR(builder.status(0).rpm, rpm, 0.01 * rpm);
      if (framing == Framing::revolution) {
        EXPECT_NEAR(to_milliseconds(scans[3].end - scans[3].begin), 60'000.0 / rpm, 0.1);
      }
    }
  }
}

TEST(Framing, TwoLidarsShareTheGridAndAFrameWaitsForBoth) {
  test::StreamOptions second{.model = "velodyne_vlp32c", .packets = 600, .seed = 3};
  second.start += std::chrono::microseconds(431);
  const auto a = test::make_stream({.packets = 300});
  const auto b = test::make_stream(second);
  auto builder = builder_for({lidar(), lidar("velodyne_vlp32c")});
  std::vector<Scan> scans;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.packets.size() || j < b.packets.size()) {
    const bool first = j == b.packets.size() ||
                       (i < a.packets.size() && a.packets[i].last_firing <= b.packets[j].last_firing);
    const auto& packet = first ? a.packets[i++] : b.packets[j++];
    ASSERT_TRUE(builder.add(first ? 0 : 1, packet.datagram()).ok());
    take_all(builder, scans);
  }
  builder.finish();
  take_all(builder, scans);
  auto expected = firing_times(a);
  const auto others = firing_times(b);
  expected.insert(expected.end(), others.begin(), others.end());
  // The grid begins with the datagram that came first: what the other LiDAR fired before is before frame 0.
  const auto before = std::erase_if(expected, [&](std::int64_t time) { return time < to_ns(second.start); });
  std::ranges::sort(expected);
  EXPECT_EQ(point_times(scans), expected);
  EXPECT_EQ(builder.status(0).points_late, before);
  for (const Scan& scan : scans) {
    expect_consistent(scan);
    std::uint32_t points = 0;
    for (const auto& counters : scan.lidars) points += counters.points;
    EXPECT_EQ(points, scan.points.size());
  }
}

/// The second one's datagrams come up to 5 ms before the first one tells that its turn is over.
TEST(Framing, ALidarThatIsAheadOfTheOneThatTurnsLosesNothingAtTheTurnsEnd) {
  const auto a = test::make_stream({.packets = 800});
  const auto b = test::make_stream({.packets = 800, .seed = 2});
  auto builder = builder_for({lidar(), lidar()}, Framing::revolution);
  std::vector<Scan> scans;
  constexpr std::size_t kAhead = 4;  // datagrams of 1.3 ms
  for (std::size_t i = 0; i < kAhead; ++i) ASSERT_TRUE(builder.add(1, b.packets[i].datagram()).ok());
  for (std::size_t i = 0; i < a.packets.size(); ++i) {
    if (i + kAhead < b.packets.size()) {
      ASSERT_TRUE(builder.add(1, b.packets[i + kAhead].datagram()).ok());
    }
    ASSERT_TRUE(builder.add(0, a.packets[i].datagram()).ok());
    take_all(builder, scans);
  }
  builder.finish();
  take_all(builder, scans);
  ASSERT_GT(scans.size(), 8U);
  auto expected = framed_times(a, scans, Framing::revolution);
  const auto others = framed_times(b, scans, Framing::revolution);
  expected.insert(expected.end(), others.begin(), others.end());
  std::ranges::sort(expected);
  EXPECT_EQ(point_times(scans), expected);
  for (const Scan& scan : scans) {
    expect_consistent(scan);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto of_lidar = [&](const ScanSegment& segment) { return segment.lidar == i; };
      std::uint32_t points = 0;
      for (const ScanSegment& segment : scan.segments) points += of_lidar(segment) ? segment.count : 0;
      EXPECT_EQ(points, scan.lidars[i].points);
      EXPECT_NEAR(scan.lidars[i].packets, 76, 2);
    }
  }
}

TEST(Framing, ASilentLidarHoldsTheOthersUpByTwentyMillisecondsAtMost) {
  const auto a = test::make_stream({.packets = 300});
  const auto b = test::make_stream({.packets = 40, .seed = 2});  // dies after 53 ms
  auto builder = builder_for({lidar(), lidar()});
  Scan scan;
  for (std::size_t i = 0; i < a.packets.size(); ++i) {
    ASSERT_TRUE(builder.add(0, a.packets[i].datagram()).ok());
    if (i < b.packets.size()) {
      ASSERT_TRUE(builder.add(1, b.packets[i].datagram()).ok());
    }
    if (builder.take(scan)) {
      EXPECT_LE(a.packets[i].last_firing - scan.end, milliseconds(22));
    }
  }
  EXPECT_EQ(scan.frame_number, 2U);
}

TEST(Framing, AFrameWhoseTimeIsOverIsFinishedInSilence) {
  const auto stream = test::make_stream({.packets = 20});
  auto builder = builder_for({lidar()});
  for (const auto& packet : stream.packets) ASSERT_TRUE(builder.add(0, packet.datagram()).ok());
  Scan scan;
  const MeasurementTime end = test::StreamOptions{}.start + milliseconds(100);
  builder.advance(end + milliseconds(19));
  EXPECT_FALSE(builder.take(scan));
  builder.advance(end + milliseconds(20));
  ASSERT_TRUE(builder.take(scan));
  EXPECT_EQ(scan.points.size(), stream.returns.size());
  EXPECT_FALSE(builder.take(scan));
}

TEST(Framing, DatagramsWithoutAnyReturnStillMakeAFrame) {
  auto builder = builder_for({lidar()});
  Datagram datagram;
  std::vector<test::VelodyneBytes> bytes;
  for (int n = 0; n < 100; ++n) {
    bytes.push_back(
        test::velodyne_bytes(test::even_azimuths(n * 480, 40), static_cast<std::uint32_t>(n) * 1327));
    datagram.bytes = bytes.back();
    datagram.received = test::StreamOptions{}.start + n * Nanoseconds(1'327'104);
    ASSERT_TRUE(builder.add(0, datagram).ok());
  }
  Scan scan;
  ASSERT_TRUE(builder.take(scan));
  EXPECT_TRUE(scan.points.empty());
  EXPECT_EQ(scan.lidars[0].packets, 76U);
}

TEST(Framing, AFloodIsCappedAndCountedAndTakesNothingFromAnotherLidar) {
  const auto flood = test::make_stream({.model = "velodyne_vlp32c", .packets = 3000});
  const auto other = test::make_stream({.packets = 10});
  auto builder = builder_for({lidar("velodyne_vlp32c"), lidar()}, Framing::period, 0.1);
  for (const auto& packet : flood.packets) ASSERT_TRUE(builder.add(0, packet.datagram()).ok());
  for (const auto& packet : other.packets) ASSERT_TRUE(builder.add(1, packet.datagram()).ok());
  builder.finish();
  Scan scan;
  ASSERT_TRUE(builder.take(scan));
  EXPECT_EQ(scan.points.size(), kMaxLidarPoints + other.returns.size());
  EXPECT_EQ(scan.lidars[1].points, other.returns.size());
  EXPECT_EQ(builder.status(0).points_over_limit, flood.returns.size() - kMaxLidarPoints);
  EXPECT_EQ(scan.lidars[0].points_over_limit, flood.returns.size() - kMaxLidarPoints);
}

TEST(Framing, FramesThatNobodyTakesAreBounded) {
  const auto stream = test::make_stream({.packets = 1000});
  auto builder = builder_for({lidar()});
  for (const auto& packet : stream.packets) ASSERT_TRUE(builder.add(0, packet.datagram()).ok());
  std::vector<Scan> scans;
  take_all(builder, scans);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans.back().frame_number, 12U);
  EXPECT_EQ(builder.frames_overrun(), 9U);
}

TEST(Framing, StampsThatRunBackByAnHourStartANewGrid) {
  auto stream = test::make_stream({.packets = 200});
  test::StreamOptions earlier{.packets = 200, .seed = 5};
  earlier.start -= seconds(3600);
  const auto again = test::make_stream(earlier);
  stream.packets.insert(stream.packets.end(), again.packets.begin(), again.packets.end());
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  EXPECT_EQ(builder.clock_steps(), 1U);
  std::size_t points = 0;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    points += scans[k].points.size();
    if (k > 0) {
      EXPECT_GT(scans[k].frame_number, scans[k - 1].frame_number);
    }
  }
  EXPECT_EQ(point_times(scans).size(), points);
  EXPECT_EQ(builder.status(0).points_late, 0U);
}

}  // namespace
}  // namespace hulltrack
