// Laws of frame building, against streams whose firings are known one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "tests/support/velodyne_bytes.hpp"
#include "tests/support/velodyne_stream.hpp"

namespace hulltrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

LidarConfig lidar(const std::string& model = "velodyne_vlp16") {
  LidarConfig config;
  config.model = model;
  return config;
}

ScanBuilder builder_for(const std::vector<LidarConfig>& lidars, Framing framing = Framing::period,
                        double rate = 10.0) {
  auto built = ScanBuilder::create(lidars, {framing, rate});
  EXPECT_TRUE(built.ok());
  return std::move(built).value();
}

void take_all(ScanBuilder& builder, std::vector<Scan>& scans) {
  Scan scan;
  while (builder.take(scan)) scans.push_back(scan);
}

std::vector<Scan> build(ScanBuilder& builder, const std::vector<test::StreamPacket>& packets) {
  std::vector<Scan> scans;
  for (const auto& packet : packets) {
    EXPECT_TRUE(builder.add(0, packet.datagram()).ok());
    take_all(builder, scans);
  }
  builder.finish();
  take_all(builder, scans);
  return scans;
}

/// Measuring times of all points, sorted.
std::vector<std::int64_t> point_times(const std::vector<Scan>& scans) {
  std::vector<std::int64_t> times;
  for (const Scan& scan : scans) {
    for (const ScanSegment& segment : scan.segments) {
      for (std::uint32_t i = 0; i < segment.count; ++i) {
        times.push_back(to_ns(segment.time) + scan.points[segment.first + i].dt_ns);
      }
    }
  }
  std::ranges::sort(times);
  return times;
}

std::vector<std::int64_t> firing_times(const test::VelodyneStream& stream) {
  std::vector<std::int64_t> times;
  for (const auto& hit : stream.returns) times.push_back(to_ns(hit.time));
  std::ranges::sort(times);
  return times;
}

void expect_consistent(const Scan& scan) {
  std::uint32_t next = 0;
  for (const ScanSegment& segment : scan.segments) {
    EXPECT_EQ(segment.first, next);
    EXPECT_GT(segment.count, 0U);
    next += segment.count;
    for (std::uint32_t i = 0; i < segment.count; ++i) {
      const MeasurementTime time = segment.time + Nanoseconds(scan.points[segment.first + i].dt_ns);
      EXPECT_GE(time, scan.begin);
      EXPECT_LT(time, scan.end);
      EXPECT_GE(time, scan.first_firing);
      EXPECT_LE(time, scan.last_firing);
    }
  }
  EXPECT_EQ(next, scan.points.size());
}

/// What of `stream` must be in `scans`: everything, but with revolution framing for the unfinished last turn.
std::vector<std::int64_t> framed_times(const test::VelodyneStream& stream, const std::vector<Scan>& scans,
                                       Framing framing) {
  std::vector<std::int64_t> times = firing_times(stream);
  if (framing == Framing::revolution) {
    std::erase_if(times, [&](std::int64_t time) { return time >= to_ns(scans.back().end); });
  }
  return times;
}

TEST(ScanBuilder, EveryPointIsInExactlyOneFrameAtItsFiringTime) {
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

TEST(ScanBuilder, PeriodsFormOneGridFromTheFirstFiring) {
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

TEST(ScanBuilder, ABoundaryInsideADatagramSplitsIt) {
  const auto stream = test::make_stream({.packets = 200});
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  ASSERT_GE(scans.size(), 2U);
  // 100 ms is no multiple of the 1.327104 ms between datagrams: the last one of frame 0 is in frame 1 too.
  EXPECT_EQ(scans[0].lidars[0].packets, 76U);
  EXPECT_LT(scans[0].segments.back().count, scans[0].segments[0].count);
  EXPECT_LT(scans[1].first_firing - scans[1].begin, std::chrono::microseconds(60));
}

TEST(ScanBuilder, NumbersSkipFramesInWhichNothingArrived) {
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

TEST(ScanBuilder, RevolutionsEndWhereTheRotorPassesZero) {
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

TEST(ScanBuilder, AnUnfinishedLastTurnIsNoFrame) {
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

TEST(ScanBuilder, AWrongRotationRateIsReportedAndFramesStayWhole) {
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

TEST(ScanBuilder, DatagramsOutOfOrderAndTwiceLeaveTheFrameAsItWas) {
  const auto stream = test::make_stream({.packets = 300});
  auto mixed = stream.packets;
  for (std::size_t i = 10; i + 2 < mixed.size(); i += 7) {
    // Swapped on the way: each keeps its bytes, the stamps follow the order of arrival.
    std::swap(mixed[i].bytes, mixed[i + 1].bytes);
  }
  for (std::size_t i = 5; i < mixed.size(); i += 11)
    mixed.insert(mixed.begin() + static_cast<long>(i), mixed[i]);
  auto plain = builder_for({lidar()});
  auto shaken = builder_for({lidar()});
  const auto expected = build(plain, stream.packets);
  const auto got = build(shaken, mixed);
  const LidarStatus status = shaken.status(0);
  EXPECT_GT(status.packets_duplicate, 20U);
  EXPECT_GT(status.packets_out_of_order, 30U);
  EXPECT_EQ(status.packets_lost, 0U);
  ASSERT_EQ(got.size(), expected.size());
  std::uint64_t points = status.points_late;
  for (std::size_t k = 0; k < got.size(); ++k) {
    points += got[k].points.size();
    expect_consistent(got[k]);
  }
  EXPECT_EQ(points, stream.returns.size());
  // A swap across a frame's end costs at most the overtaken datagram.
  EXPECT_LE(status.points_late, 2U * 384U);
}

TEST(ScanBuilder, LossIsCountedFromTheSensorsClockAcrossTheHour) {
  test::StreamOptions options{.packets = 2000};
  options.encoder.utc = seconds(3599);
  auto stream = test::make_stream(options);
  std::vector<test::StreamPacket> kept;
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < stream.packets.size(); ++i) {
    if (i % 20 == 7 || i % 50 == 30 || i % 50 == 31) {
      ++dropped;
    } else {
      kept.push_back(stream.packets[i]);
    }
  }
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, kept);
  EXPECT_EQ(builder.status(0).packets_lost, dropped);
  EXPECT_EQ(builder.status(0).clock_restarts, 0U);
  EXPECT_NEAR(builder.status(0).loss, static_cast<double>(dropped) / 2000.0, 0.01);
  std::uint64_t lost_in_frames = 0;
  for (const Scan& scan : scans) lost_in_frames += scan.lidars[0].packets_lost;
  EXPECT_EQ(lost_in_frames, dropped);
}

TEST(ScanBuilder, ACountThatStandsStillTellsNoLossTheClockDoes) {
  test::StreamOptions options{.model = "livox_mid360", .slots = 96, .packets = 1000};
  options.encoder.utc = options.start.time_since_epoch();
  const auto stream = test::make_stream(options);
  std::vector<test::StreamPacket> kept;
  for (std::size_t i = 0; i < stream.packets.size(); ++i) {
    if (i % 20 != 7) kept.push_back(stream.packets[i]);
  }
  auto config = lidar();
  config.model = options.model;
  constexpr std::size_t kCount = 7;
  for (const bool counts : {true, false}) {
    for (auto& packet : kept) {
      if (!counts) packet.bytes[kCount] = packet.bytes[kCount + 1] = 0;
    }
    auto builder = builder_for({config});
    static_cast<void>(build(builder, kept));
    EXPECT_EQ(builder.status(0).packets_lost, 50U) << counts;
  }
}

TEST(ScanBuilder, ASensorThatRestartsIsFollowedWithoutALoss) {
  auto before = test::make_stream({.packets = 200});
  test::StreamOptions later{.packets = 200, .seed = 2};
  later.start += seconds(40);
  const auto after = test::make_stream(later);
  before.packets.insert(before.packets.end(), after.packets.begin(), after.packets.end());
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, before.packets);
  EXPECT_EQ(builder.status(0).packets_lost, 0U);
  EXPECT_EQ(builder.status(0).clock_restarts, 1U);
  EXPECT_EQ(scans.back().frame_number, 402U);
}

TEST(ScanBuilder, AFrozenSensorClockCostsNoPoints) {
  auto stream = test::make_stream({.packets = 200});
  for (auto& packet : stream.packets) std::fill_n(packet.bytes.begin() + 1200, 4, std::uint8_t{0});
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  EXPECT_EQ(point_times(scans), firing_times(stream));
}

TEST(ScanBuilder, TwoLidarsShareTheGridAndAFrameWaitsForBoth) {
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

TEST(ScanBuilder, ASilentLidarHoldsTheOthersUpByTwentyMillisecondsAtMost) {
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

TEST(ScanBuilder, AFrameWhoseTimeIsOverIsFinishedInSilence) {
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

TEST(ScanBuilder, DatagramsWithoutAnyReturnStillMakeAFrame) {
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

TEST(ScanBuilder, AFloodIsCappedAndCountedAndTakesNothingFromAnotherLidar) {
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

TEST(ScanBuilder, FramesThatNobodyTakesAreBounded) {
  const auto stream = test::make_stream({.packets = 1000});
  auto builder = builder_for({lidar()});
  for (const auto& packet : stream.packets) ASSERT_TRUE(builder.add(0, packet.datagram()).ok());
  std::vector<Scan> scans;
  take_all(builder, scans);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans.back().frame_number, 12U);
  EXPECT_EQ(builder.frames_overrun(), 9U);
}

TEST(ScanBuilder, AnotherModelIsRefusedByName) {
  const auto stream = test::make_stream({.model = "velodyne_vlp32c", .packets = 10});
  auto builder = builder_for({lidar()});
  for (const auto& packet : stream.packets) {
    EXPECT_EQ(builder.add(0, packet.datagram()).status, DecodeStatus::wrong_product);
  }
  EXPECT_EQ(builder.status(0).packets, 0U);
  EXPECT_EQ(builder.status(0).packets_rejected, 10U);
  EXPECT_EQ(builder.last_rejection(0),
            "expected VLP-16 (product code 0x22), saw VLP-32C (product code 0x28) from 0.0.0.0:0");
}

TEST(ScanBuilder, TheImusDatagramsOnThePointsPortAreNoForeignOnes) {
  auto config = lidar();
  config.model = "livox_mid360";
  auto builder = builder_for({config});
  std::vector<std::uint8_t> imu(60);
  imu[1] = 60;  // its length; data type and protocol version are 0
  Datagram datagram;
  datagram.bytes = imu;
  EXPECT_TRUE(builder.add(0, datagram).ok());
  EXPECT_EQ(builder.status(0).informations, 1U);
  EXPECT_EQ(builder.status(0).packets, 0U) << "a sensor that sends no points is silent";
  EXPECT_EQ(builder.status(0).packets_rejected, 0U);
}

TEST(ScanBuilder, AChangeOfReturnModeIsCountedAndDecoded) {
  auto stream = test::make_stream({.packets = 50});
  test::StreamOptions later{.packets = 50};
  later.encoder.return_mode = ReturnMode::dual;
  later.start = stream.packets.back().last_firing + milliseconds(1);
  later.encoder.utc = later.start - test::StreamOptions{}.start;
  const auto dual = test::make_stream(later);
  stream.packets.insert(stream.packets.end(), dual.packets.begin(), dual.packets.end());
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  EXPECT_EQ(builder.status(0).return_mode_changes, 1U);
  EXPECT_EQ(builder.status(0).return_mode, ReturnMode::dual);
  EXPECT_EQ(builder.status(0).packets_rejected, 0U);
}

TEST(ScanBuilder, SensorTimeIsUsedWhileItAgreesWithTheHost) {
  test::StreamOptions options{.packets = 100};
  const Nanoseconds into_hour = options.start.time_since_epoch() % seconds(3600);
  auto config = lidar();
  config.time_source = TimeSource::sensor;
  for (const auto& [offset, believed] : {std::pair<Nanoseconds, bool>{milliseconds(5), true},
                                         {milliseconds(-5), true},
                                         {seconds(37), false},
                                         {-into_hour, false}}) {  // clock started at zero
    options.encoder.utc = (into_hour + offset + seconds(3600)) % seconds(3600);
    const auto stream = test::make_stream(options);
    auto builder = builder_for({config});
    const auto scans = build(builder, stream.packets);
    EXPECT_EQ(builder.status(0).clock_fault, !believed);
    const MeasurementTime expected = options.start + (believed ? offset : Nanoseconds::zero());
    EXPECT_NEAR(to_milliseconds(scans[0].begin - expected), 0.0, 0.002);
    if (offset == seconds(37)) {
      EXPECT_NEAR(to_seconds(builder.status(0).clock.offset), 37.0, 1e-3);
    }
  }
}

TEST(ScanBuilder, AClockThatSaysItFollowsNothingIsNotUsedHoweverNearItIs) {
  test::StreamOptions options{.model = "livox_mid360", .slots = 96, .packets = 100};
  options.encoder.utc = options.start.time_since_epoch() + milliseconds(5);
  auto stream = test::make_stream(options);
  auto config = lidar();
  config.model = options.model;
  config.time_source = TimeSource::sensor;
  constexpr std::size_t kTimeType = 11;
  for (const bool synchronised : {true, false}) {
    for (auto& packet : stream.packets) packet.bytes[kTimeType] = synchronised ? 1 : 0;  // PTP, nothing
    auto builder = builder_for({config});
    const auto scans = build(builder, stream.packets);
    EXPECT_EQ(builder.status(0).clock_fault, !synchronised);
    EXPECT_NEAR(to_milliseconds(builder.status(0).clock.offset), 5.0, 1e-3);
    EXPECT_NEAR(to_milliseconds(scans[0].begin - options.start), synchronised ? 5.0 : 0.0, 1e-3);
  }
}

TEST(ScanBuilder, StampsThatRunBackByAnHourStartANewGrid) {
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

/// What a sensor with a field of view sends: blocks inside the sector only, packed twelve at a time.
test::VelodyneStream cut_to_sector(const test::VelodyneStream& whole, int from, int to) {
  test::VelodyneStream cut;
  std::vector<std::uint8_t> bytes;
  for (const auto& packet : whole.packets) {
    const std::uint32_t stamp = static_cast<std::uint32_t>(packet.bytes[1200]) | packet.bytes[1201] << 8U |
                                packet.bytes[1202] << 16U |
                                static_cast<std::uint32_t>(packet.bytes[1203]) << 24U;
    for (std::size_t block = 0; block < 12; ++block) {
      const auto* begin = packet.bytes.data() + block * 100;
      const int azimuth = begin[2] | begin[3] << 8;
      if (azimuth < from || azimuth > to) continue;
      if (bytes.empty()) {
        bytes.assign(1206, 0);
        const auto first =
            static_cast<std::uint32_t>(stamp + std::lround(static_cast<double>(block) * 110.592));
        for (std::size_t i = 0; i < 4; ++i) bytes[1200 + i] = static_cast<std::uint8_t>(first >> (8 * i));
        bytes[1204] = packet.bytes[1204];
        bytes[1205] = packet.bytes[1205];
        cut.packets.push_back({});
      }
      std::size_t filled = 0;
      while (filled < 12 && bytes[filled * 100] != 0) ++filled;
      std::copy_n(begin, 100, bytes.data() + filled * 100);
      if (filled == 11) {
        const auto later = static_cast<int>(11 - block);
        cut.packets.back().bytes = bytes;
        cut.packets.back().last_firing = packet.last_firing - later * Nanoseconds(110'592);
        bytes.clear();
      }
    }
  }
  if (!bytes.empty()) cut.packets.pop_back();
  return cut;
}

TEST(ScanBuilder, ASectorThatTheSensorLeavesOutIsNoLossAndKeepsItsTimes) {
  test::StreamOptions options{.packets = 3000};
  const auto whole = test::make_stream(options);
  const auto cut = cut_to_sector(whole, 4000, 13000);
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, cut.packets);
  EXPECT_TRUE(builder.status(0).field_of_view_cut);
  EXPECT_LE(builder.status(0).packets_lost,
            60U);  // one sector's worth, until the first jump inside a datagram
  EXPECT_NEAR(builder.status(0).loss, 0.0, 1e-9);
  const auto times = firing_times(whole);
  for (const std::int64_t time : point_times(scans)) {
    const auto nearest = std::ranges::lower_bound(times, time - 60'000);
    ASSERT_NE(nearest, times.end());
    EXPECT_LE(std::abs(*nearest - time), 60'000);  // the jump's length is known to a rounded azimuth step
  }
}

TEST(ScanBuilder, CreationRefusesWhatItCannotRun) {
  EXPECT_FALSE(ScanBuilder::create({}, {}).ok());
  EXPECT_FALSE(ScanBuilder::create({lidar()}, {Framing::period, 0.0}).ok());
  const auto unknown = ScanBuilder::create({lidar("velodyne_vlp17")}, {});
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().message.find("velodyne_vlp17"), std::string::npos);
}

TEST(ScanBuilder, PointsFartherThanTheModelMeasuresAreDroppedAndCounted) {
  auto stream = test::make_stream({.packets = 1});
  auto& bytes = stream.packets[0].bytes;
  for (std::size_t block = 0; block < 12; ++block) {
    for (std::size_t slot = 0; slot < 32; ++slot) write_le16(bytes, 100 * block + 4 + 3 * slot, 0);
  }
  // A VLP-16 measures 100 m, in steps of 2 mm. Slot 1: its laser's height above the centre takes 12 um off.
  const auto put = [&](std::size_t block, unsigned raw) {
    write_le16(bytes, 100 * block + 4 + 3, static_cast<std::uint16_t>(raw));
  };
  put(0, 50'000);
  put(1, 50'001);
  put(2, 65'535);
  auto builder = builder_for({lidar()});
  const auto scans = build(builder, stream.packets);
  ASSERT_EQ(scans.size(), 1U);
  ASSERT_EQ(scans[0].points.size(), 1U);
  EXPECT_NEAR(std::hypot(scans[0].points[0].x, scans[0].points[0].y), 100.0 * std::cos(radians(1.0)), 1e-4);
  EXPECT_EQ(builder.status(0).points_out_of_range, 2U);
}

}  // namespace
}  // namespace hulltrack
