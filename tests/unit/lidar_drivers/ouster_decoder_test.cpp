// The decoder against datagrams written by hand from the format's description: places, times, counts, bad
// bytes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/ouster/ouster_decoder.hpp"
#include "tests/support/ouster_bytes.hpp"

namespace hulltrack {
namespace {

using test::OusterBytes;
using test::OusterText;
using Kind = OusterBytes::Kind;

constexpr double kTurn = 2.0 * std::numbers::pi;

const char* profile_name(Kind kind) {
  switch (kind) {
    case Kind::legacy:
      return "LEGACY";
    case Kind::single:
      return "RNG19_RFL8_SIG16_NIR16";
    case Kind::dual:
      return "RNG19_RFL8_SIG16_NIR16_DUAL";
    case Kind::low:
      break;
  }
  return "RNG15_RFL8_NIR8";
}

ouster::OusterDecoder decoder_of(Kind kind, const DecoderOptions& options = {}, OusterText text = {}) {
  text.profile = profile_name(kind);
  return {ouster::parse_metadata(text.nested(), "os.json").value(), options};
}

DecodedPacket decode(const ouster::OusterDecoder& decoder, const OusterBytes& datagram) {
  DecodedPacket packet;
  const DecodeOutcome outcome = decoder.decode(datagram.bytes, packet);
  EXPECT_TRUE(outcome.ok()) << decoder.explain(outcome);
  return packet;
}

DecodedPacket decode(Kind kind, const OusterBytes& datagram, const DecoderOptions& options = {}) {
  return decode(decoder_of(kind, options), datagram);
}

std::string explanation_of(const ouster::OusterDecoder& decoder, const OusterBytes& datagram) {
  DecodedPacket packet;
  return decoder.explain(decoder.decode(datagram.bytes, packet));
}

void expect_at(const LidarPoint& point, double x, double y, double z) {
  EXPECT_NEAR(point.x, x, 1e-5);
  EXPECT_NEAR(point.y, y, 1e-5);
  EXPECT_NEAR(point.z, z, 1e-5);
}

TEST(OusterDecoder, XPointsAwayFromTheConnectorAndColumnsRunClockwise) {
  OusterBytes datagram(Kind::single, 0);
  datagram.put_return(0, 1, 10'000, 77);
  const auto back = decode(Kind::single, datagram).points.at(0);
  expect_at(back, -10.0, 0.0, 0.036);  // measurement 0 is over the connector
  EXPECT_EQ(back.intensity, 77);
  EXPECT_EQ(back.channel, 1);
  EXPECT_EQ(back.echo, 0);

  OusterBytes left(Kind::single, 256);
  left.put_return(0, 1, 10'000, 77);
  expect_at(decode(Kind::single, left).points.at(0), 0.0, 10.0, 0.036);
}

TEST(OusterDecoder, BeamsLeaveFromBesideTheAxisAtTheirOwnAngles) {
  OusterBytes datagram(Kind::single, 512);  // towards +x
  datagram.put_return(0, 0, 5'000, 1);      // 30 deg up
  datagram.put_return(0, 15, 5'000, 2);     // 30 deg down
  datagram.put_return(0, 2, 5'000, 3);      // 10 deg to the right: a beam's azimuth counts clockwise
  const auto points = decode(Kind::single, datagram).points;
  ASSERT_EQ(points.size(), 3U);
  const double up = std::numbers::pi / 6.0;
  const double aside = std::numbers::pi / 18.0;
  expect_at(points[0], 4.99 * std::cos(up) + 0.01, 0.0, 4.99 * std::sin(up) + 0.036);
  expect_at(points[1], 4.99 * std::cos(aside) + 0.01, -4.99 * std::sin(aside), 0.036);
  expect_at(points[2], 4.99 * std::cos(up) + 0.01, 0.0, -4.99 * std::sin(up) + 0.036);
}

TEST(OusterDecoder, ABeamsOriginMayLieAboveTheAxis) {
  OusterText text;
  text.origin = R"("beam_to_lidar_transform": [1, 0, 0, 12, 0, 1, 0, 0, 0, 0, 1, 5, 0, 0, 0, 1])";
  OusterBytes datagram(Kind::single, 512);
  datagram.put_return(0, 1, 5'013, 1);
  expect_at(decode(decoder_of(Kind::single, {}, text), datagram).points.at(0), 5.012, 0.0, 0.041);
}

TEST(OusterDecoder, EveryProfileHasItsOwnPixel) {
  struct Case {
    Kind kind;
    std::uint32_t code;
    double range;
  };
  for (const Case& c :
       {Case{Kind::legacy, 0xFFFFF, 1048.575}, Case{Kind::single, 0x7FFFF, 524.287},
        Case{Kind::dual, 0x7FFFF, 524.287}, Case{Kind::low, 0x7FFF, 262.136}, Case{Kind::legacy, 1234, 1.234},
        Case{Kind::single, 1234, 1.234}, Case{Kind::dual, 1234, 1.234}, Case{Kind::low, 1234, 9.872}}) {
    OusterBytes datagram(c.kind, 512);
    for (int column = 0; column < 16; ++column) datagram.put_return(column, 0, 0, 9);  // no return
    datagram.put_return(0, 1, c.code, 200);
    datagram.put_return(15, 14, c.code, 201);
    const auto points = decode(c.kind, datagram).points;
    ASSERT_EQ(points.size(), 2U) << profile_name(c.kind);
    EXPECT_NEAR(points[0].x, c.range, 1e-4);
    EXPECT_EQ(points[0].intensity, 200);
    EXPECT_EQ(points[1].intensity, 201);
    EXPECT_EQ(points[1].channel, 14);
    EXPECT_NEAR(std::hypot(points[1].x, points[1].y), c.range, 1e-4);
  }
}

TEST(OusterDecoder, OfTwoEchoesTheFartherIsTheLast) {
  OusterBytes datagram(Kind::dual, 512);
  datagram.put_return(0, 1, 6'000, 10);
  datagram.put_return(0, 1, 4'000, 90, true);
  datagram.put_return(1, 1, 4'000, 91);
  datagram.put_return(1, 1, 6'000, 11, true);
  datagram.put_return(2, 1, 5'000, 12);
  datagram.put_return(2, 1, 5'000, 12, true);  // the same echo again
  datagram.put_return(3, 1, 0, 0);
  datagram.put_return(3, 1, 7'000, 13, true);
  const auto packet = decode(Kind::dual, datagram);
  EXPECT_EQ(packet.return_mode, ReturnMode::dual);
  ASSERT_EQ(packet.points.size(), 6U);
  const std::pair<int, int> expected[] = {{10, 0}, {90, 1}, {91, 1}, {11, 0}, {12, 0}, {13, 0}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(packet.points[i].intensity, expected[i].first) << i;
    EXPECT_EQ(packet.points[i].echo, expected[i].second) << i;
  }
  const auto all = decode(Kind::dual, datagram, {.repeated_echoes = true}).points;
  ASSERT_EQ(all.size(), 7U);
  EXPECT_EQ(all[5].echo, 1);
}

TEST(OusterDecoder, ColumnsAreDatedByTheirOwnStamps) {
  OusterBytes datagram(Kind::single, 512, 7'000'000'000, 97'656);
  datagram.set_stamp(4, 7'000'000'000 + 4 * 97'656 + 4'000);  // the rotor is not quite even
  for (const int column : {0, 4, 15}) datagram.put_return(column, 1, 5'000, 1);
  const auto packet = decode(Kind::single, datagram);
  EXPECT_EQ(packet.sensor_time, Nanoseconds(7'000'000'000 + 15 * 97'656));
  EXPECT_EQ(packet.duration, Nanoseconds(15 * 97'656));
  EXPECT_EQ(packet.interval, Nanoseconds(16 * 97'656));
  ASSERT_EQ(packet.points.size(), 3U);
  EXPECT_EQ(packet.points[0].dt_ns, -15 * 97'656);
  EXPECT_EQ(packet.points[1].dt_ns, -11 * 97'656 + 4'000);
  EXPECT_EQ(packet.points[2].dt_ns, 0);
  EXPECT_NEAR(packet.rotation_rate, kTurn * 10.0, 1e-3);
  EXPECT_DOUBLE_EQ(packet.first_azimuth, kTurn * 0.5);
  EXPECT_DOUBLE_EQ(packet.last_azimuth, kTurn * 527.0 / 1024.0);
  EXPECT_FALSE(packet.zero_crossing);
  EXPECT_FALSE(packet.cut_azimuth);
  EXPECT_EQ(packet.return_mode, ReturnMode::strongest);
}

TEST(OusterDecoder, AClockThatIsSetBetweenTwoColumnsIsNotFollowed) {
  constexpr std::uint64_t kFar = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t stamp : {std::uint64_t{0}, std::uint64_t{7'000'000'000}, kFar}) {
    for (const int column : {0, 8, 15}) {
      OusterBytes datagram(Kind::single, 512, 7'000'000'000, 97'656);
      datagram.set_stamp(column, stamp);
      if (column == 0 && stamp == 7'000'000'000) continue;  // its own
      for (int c = 0; c < 16; ++c) datagram.put_return(c, 1, 5'000, 1);
      const auto packet = decode(Kind::single, datagram);
      ASSERT_EQ(packet.points.size(), 16U);
      for (int c = 0; c < 16; ++c)
        EXPECT_NEAR(packet.points[static_cast<std::size_t>(c)].dt_ns, (c - 15) * 97'656.25, 1.0);
      EXPECT_NEAR(packet.rotation_rate, kTurn * 10.0, 1e-3);
      EXPECT_LT(packet.sensor_time.count(), std::int64_t{1} << 62);
      EXPECT_GE(packet.sensor_time.count(), 0);
    }
  }
}

TEST(OusterDecoder, SaysOfItsClockWhatTheMetadataSay) {
  auto metadata = ouster::parse_metadata(OusterText{}.flat(), "os.json").value();
  metadata.clock_reference = ClockReference::ptp;
  const ouster::OusterDecoder decoder(metadata, {});
  EXPECT_EQ(decode(decoder, OusterBytes(Kind::single)).clock_reference, ClockReference::ptp);
}

TEST(OusterDecoder, TheTurnBeginsAtMeasurementZero) {
  const auto packet = decode(Kind::single, OusterBytes(Kind::single, 0, 1'000'000'000, 97'656));
  ASSERT_TRUE(packet.zero_crossing);
  EXPECT_EQ(*packet.zero_crossing, Nanoseconds(-15 * 97'656));
}

TEST(OusterDecoder, InvalidColumnsHaveNoPointsAndNoSay) {
  for (const Kind kind : {Kind::legacy, Kind::single, Kind::dual, Kind::low}) {
    OusterBytes datagram(kind, 64, 1'000'000'000, 97'656);
    for (int c = 0; c < 16; ++c) datagram.put_return(c, 1, 5'000, 1);
    for (const int c : {0, 7, 15}) {
      datagram.set_valid(c, false);
      datagram.set_id(c, 9999);
      datagram.set_stamp(c, 0);
    }
    const auto packet = decode(kind, datagram);
    EXPECT_EQ(packet.points.size(), 13U);
    EXPECT_EQ(packet.sensor_time, Nanoseconds(1'000'000'000 + 14 * 97'656));
    EXPECT_EQ(packet.duration, Nanoseconds(13 * 97'656));
    EXPECT_DOUBLE_EQ(packet.first_azimuth, kTurn * 65.0 / 1024.0);
  }
}

TEST(OusterDecoder, ADatagramWithoutAValidColumnStillHasItsTimeAndPlace) {
  OusterBytes datagram(Kind::legacy, 64, 1'000'000'000, 97'656);
  for (int c = 0; c < 16; ++c) {
    datagram.put_return(c, 1, 5'000, 1);
    datagram.set_valid(c, false);
  }
  const auto packet = decode(Kind::legacy, datagram);
  EXPECT_TRUE(packet.points.empty());
  EXPECT_EQ(packet.sensor_time, Nanoseconds(1'000'000'000 + 15 * 97'656));
  ASSERT_TRUE(packet.counter);
  EXPECT_EQ(packet.counter->value, 3U * 64 + 4);
}

TEST(OusterDecoder, DatagramsAreCountedByFrameAndPlace) {
  for (const Kind kind : {Kind::legacy, Kind::single}) {
    const auto decoder = decoder_of(kind);
    const auto last = decode(decoder, OusterBytes(kind, 1008, 1, 97'656, 65'535)).counter;
    const auto first = decode(decoder, OusterBytes(kind, 0, 1, 97'656, 0)).counter;
    ASSERT_TRUE(first && last);
    EXPECT_EQ(last->wrap, 65'536U * 64);
    EXPECT_EQ(last->value, last->wrap - 1);
    EXPECT_EQ(first->value, 0U);
  }
}

TEST(OusterDecoder, AWindowsDatagramsAreCountedWithoutThoseLeftOut) {
  OusterText text;
  text.window = "[100, 699]";  // datagrams 6 to 43 of 64
  const auto decoder = decoder_of(Kind::single, {}, text);
  const auto first = decode(decoder, OusterBytes(Kind::single, 96));
  const auto last = decode(decoder, OusterBytes(Kind::single, 688));
  ASSERT_TRUE(first.counter && last.counter);
  EXPECT_EQ(first.counter->value, 3U * 38);
  EXPECT_EQ(last.counter->value, 3U * 38 + 37);
  EXPECT_EQ(first.counter->wrap, 65'536U * 38);
  EXPECT_FALSE(decode(decoder, OusterBytes(Kind::single, 704)).counter);
  ASSERT_TRUE(first.cut_azimuth);
  EXPECT_DOUBLE_EQ(*first.cut_azimuth, kTurn * 699.0 / 1024.0);

  text.window = "[1000, 199]";  // through zero: datagrams 0 to 12, 62 and 63
  const auto through_zero = decode(decoder_of(Kind::single, {}, text), OusterBytes(Kind::single, 992));
  ASSERT_TRUE(through_zero.counter);
  EXPECT_EQ(through_zero.counter->value, 3U * 15 + 13);
}

TEST(OusterDecoder, TheImusDatagramsAreItsOwnAndHoldNoPoints) {
  auto decoder = decoder_of(Kind::single);
  EXPECT_TRUE(decoder.inform(std::vector<std::uint8_t>(48)));
  EXPECT_FALSE(decoder.inform(std::vector<std::uint8_t>(47)));
  EXPECT_FALSE(decoder.inform(OusterBytes(Kind::single).bytes));
}

TEST(OusterDecoder, RefusalsNameWhatWasExpectedAndSeen) {
  const auto decoder = decoder_of(Kind::single);
  const OusterBytes good(Kind::single);
  EXPECT_EQ(explanation_of(decoder, good), "ok");
  OusterBytes imu = good;
  imu.bytes.resize(48);
  EXPECT_EQ(explanation_of(decoder, imu),
            "expected datagrams of 3328 bytes, as the metadata's RNG19_RFL8_SIG16_NIR16 with 16 beams has, "
            "saw 48 bytes");
  OusterBytes type = good;
  type.put(0, 3, 2);
  EXPECT_EQ(explanation_of(decoder, type), "expected packet type 1 (lidar), saw 3");
  OusterBytes stranger = good;
  stranger.put(7, 122'000'000'008, 5);
  EXPECT_EQ(explanation_of(decoder, stranger),
            "expected sensor 122000000007, whose metadata was given, saw another one's datagrams");
  stranger.put(7, 0, 5);  // not told
  EXPECT_EQ(explanation_of(decoder, stranger), "ok");
  OusterBytes beyond = good;
  beyond.set_id(9, 1024);
  EXPECT_EQ(explanation_of(decoder, beyond), "expected rising measurement ids below 1024, saw 1024");
  OusterBytes twice = good;
  twice.set_id(9, 8);
  EXPECT_EQ(explanation_of(decoder, twice), "expected rising measurement ids below 1024, saw 8");
}

TEST(OusterDecoder, FlippedBitsNeverLeadOutOfBounds) {
  std::mt19937 random(7);
  for (const Kind kind : {Kind::legacy, Kind::single, Kind::dual, Kind::low}) {
    const auto decoder = decoder_of(kind);
    OusterBytes clean(kind, 1008);
    for (int c = 0; c < 16; ++c) {
      for (int row = 0; row < 16; ++row) clean.put_return(c, row, 3'000, 9);
    }
    DecodedPacket packet;
    for (std::size_t size = 0; size < clean.bytes.size(); ++size) {
      EXPECT_FALSE(decoder.decode(Bytes(clean.bytes).first(size), packet).ok());
    }
    for (int run = 0; run < 5'000; ++run) {
      auto bytes = clean.bytes;
      for (int i = 0; i < 20; ++i)
        bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
      if (!decoder.decode(bytes, packet).ok()) {
        EXPECT_TRUE(packet.points.empty());
        continue;
      }
      EXPECT_LE(packet.points.size(), 512U);
      EXPECT_LE(packet.duration, std::chrono::milliseconds(200));
      EXPECT_GT(packet.interval, Nanoseconds::zero());
      for (const LidarPoint& point : packet.points) {
        EXPECT_LE(point.dt_ns, 0);
        EXPECT_GE(point.dt_ns, -packet.duration.count());
        EXPECT_LE(std::hypot(point.x, point.y, point.z), ouster::kMaxRange + 0.1);
      }
    }
  }
}

}  // namespace
}  // namespace hulltrack
