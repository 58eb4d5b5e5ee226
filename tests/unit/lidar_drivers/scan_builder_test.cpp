// What is counted, which clock is used, what is refused: a LiDAR's datagrams one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
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

TEST(ScanBuilder, TwoSensorsOnOnePortAreNeverMixedAndNamed) {
  const auto stream = test::make_stream({.packets = 300});
  auto alone = builder_for({lidar()});
  const auto expected = build(alone, stream.packets);
  auto builder = builder_for({lidar()});
  std::vector<Scan> got;
  for (const auto& packet : stream.packets) {
    Datagram datagram = packet.datagram();
    datagram.source_ip = 0xC0A801C9;
    EXPECT_TRUE(builder.takes(0, datagram));
    EXPECT_TRUE(builder.add(0, datagram).ok());
    datagram.source_ip = 0xC0A801CA;
    EXPECT_FALSE(builder.takes(0, datagram));
    take_all(builder, got);
  }
  builder.finish();
  take_all(builder, got);
  EXPECT_EQ(point_times(got), point_times(expected));
  for (const Scan& scan : got) EXPECT_GT(scan.lidars[0].packets_rejected, 0U);
  EXPECT_EQ(builder.two_senders(0), "two sensors send to UDP port 2368: 192.168.1.201 and 192.168.1.202");
  EXPECT_EQ(builder.status(0).packets_of_another, 300U);
  EXPECT_TRUE(builder.status(0).disputed);
  EXPECT_EQ(alone.two_senders(0), "");
}

TEST(ScanBuilder, ASourceAddressLeavesNothingToDispute) {
  LidarConfig named = lidar();
  named.source = "192.168.1.201";  // whoever hands over datagrams has looked
  auto builder = builder_for({named});
  const auto stream = test::make_stream({.packets = 20});
  for (std::size_t i = 0; i < stream.packets.size(); ++i) {
    Datagram datagram = stream.packets[i].datagram();
    datagram.source_ip = 0xC0A801C9 + static_cast<std::uint32_t>(i % 2);
    EXPECT_TRUE(builder.takes(0, datagram));
    EXPECT_TRUE(builder.add(0, datagram).ok());
  }
  EXPECT_FALSE(builder.status(0).disputed);
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

TEST(ScanBuilder, AClockThatIsSetByMillisecondsCarriesNoPointBeyondTheTolerance) {
  auto config = lidar();
  config.time_source = TimeSource::sensor;
  const auto stream_at = [](Nanoseconds since_start, Nanoseconds ahead) {
    test::StreamOptions options{.packets = 30};
    options.start += since_start;
    options.encoder.utc = options.start.time_since_epoch() % seconds(3600) + ahead;
    return test::make_stream(options);
  };
  for (const int sign : {1, -1}) {
    auto builder = builder_for({config});
    std::vector<Scan> scans;
    MeasurementTime last{};
    for (const auto& [since, ahead] : {std::pair(milliseconds(0), 19), {milliseconds(50), 41}}) {
      for (const auto& packet : stream_at(since, sign * milliseconds(ahead)).packets) {
        ASSERT_TRUE(builder.add(0, packet.datagram()).ok());
        last = packet.last_firing;
      }
    }
    builder.finish();
    take_all(builder, scans);
    ASSERT_FALSE(builder.status(0).clock_fault) << "within the second nobody has noticed";
    EXPECT_NEAR(to_milliseconds(scans.back().last_firing - last), 0.0, 0.1);
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
