// The decoder against datagrams written by hand from the protocols: kinds of record, times, tags, bad bytes.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/livox/livox_decoder.hpp"
#include "tests/support/livox_bytes.hpp"

namespace hulltrack {
namespace {

using test::LivoxBytes;

livox::LivoxDecoder decoder_of(const char* model, const DecoderOptions& options = {}) {
  return {*livox::find_model(model), options};
}

DecodedPacket decode(const char* model, const LivoxBytes& datagram, const DecoderOptions& options = {}) {
  const auto decoder = decoder_of(model, options);
  DecodedPacket packet;
  const DecodeOutcome outcome = decoder.decode(datagram.bytes, packet);
  EXPECT_TRUE(outcome.ok()) << decoder.explain(outcome);
  return packet;
}

std::string explanation_of(const char* model, const LivoxBytes& datagram) {
  const auto decoder = decoder_of(model);
  DecodedPacket packet;
  return decoder.explain(decoder.decode(datagram.bytes, packet));
}

void expect_point(const LidarPoint& point, double x, double y, double z, int reflectivity) {
  EXPECT_NEAR(point.x, x, 1e-5);
  EXPECT_NEAR(point.y, y, 1e-5);
  EXPECT_NEAR(point.z, z, 1e-5);
  EXPECT_EQ(int{point.intensity}, reflectivity);
}

TEST(LivoxDecoder, SecondGenerationCartesian) {
  auto datagram = LivoxBytes::second(1, 14, 96);
  datagram.record(7, {{-1019, 4}, {-1705, 4}, {2494, 4}, {44, 1}, {0, 1}});
  const auto packet = decode("livox_mid360", datagram);
  ASSERT_EQ(packet.points.size(), 1U);
  expect_point(packet.points[0], -1.019, -1.705, 2.494, 44);
  EXPECT_EQ(packet.points[0].channel, 3);
  EXPECT_EQ(packet.points[0].echo, 0);
  EXPECT_EQ(packet.return_mode, ReturnMode::unknown);

  auto narrow = LivoxBytes::second(2, 8, 96);
  narrow.record(95, {{-101, 2}, {-170, 2}, {249, 2}, {45, 1}, {0, 1}});
  expect_point(decode("livox_mid360", narrow).points.at(0), -1.01, -1.70, 2.49, 45);
}

TEST(LivoxDecoder, AnglesCountFromUpAndFromForward) {
  auto datagram = LivoxBytes::second(3, 10, 96);
  datagram.record(0, {{5000, 4}, {0, 2}, {12'345, 2}, {1, 1}, {0, 1}});
  datagram.record(1, {{5000, 4}, {9000, 2}, {0, 2}, {2, 1}, {0, 1}});
  datagram.record(2, {{5000, 4}, {9000, 2}, {9000, 2}, {3, 1}, {0, 1}});
  datagram.record(3, {{5000, 4}, {12'000, 2}, {27'000, 2}, {4, 1}, {0, 1}});
  const auto points = decode("livox_hap", datagram).points;
  ASSERT_EQ(points.size(), 4U);
  expect_point(points[0], 0.0, 0.0, 5.0, 1);
  expect_point(points[1], 5.0, 0.0, 0.0, 2);
  expect_point(points[2], 0.0, 5.0, 0.0, 3);
  expect_point(points[3], 0.0, -5.0 * std::sqrt(0.75), -2.5, 4);
}

TEST(LivoxDecoder, OfSeveralEchoesTheFarthestIsTheLast) {
  auto datagram = LivoxBytes::second(0x11, 28, 48);
  datagram.record(0, {{6000, 4}, {0, 4}, {0, 4}, {1, 1}, {0, 1}, {4000, 4}, {0, 4}, {0, 4}, {2, 1}, {0, 1}});
  datagram.record(1, {{4000, 4}, {0, 4}, {0, 4}, {3, 1}, {0, 1}, {6000, 4}, {0, 4}, {0, 4}, {4, 1}, {0, 1}});
  datagram.record(2, {{4000, 4}, {0, 4}, {0, 4}, {5, 1}, {0, 1}, {4000, 4}, {0, 4}, {0, 4}, {5, 1}, {0, 1}});
  datagram.record(3, {{0, 4}, {0, 4}, {0, 4}, {0, 1}, {0, 1}, {4000, 4}, {0, 4}, {0, 4}, {6, 1}, {0, 1}});
  const auto packet = decode("livox_hap", datagram);
  EXPECT_EQ(packet.return_mode, ReturnMode::dual);
  ASSERT_EQ(packet.points.size(), 6U);
  const std::pair<int, int> expected[] = {{1, 0}, {2, 1}, {3, 1}, {4, 0}, {5, 0}, {6, 0}};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(int{packet.points[i].intensity}, expected[i].first) << i;
    EXPECT_EQ(int{packet.points[i].echo}, expected[i].second) << i;
  }
  EXPECT_EQ(packet.points[5].channel, 3);  // the echoes of a shot are one laser's
  EXPECT_EQ(decode("livox_hap", datagram, {.repeated_echoes = true}).points.size(), 7U);
}

TEST(LivoxDecoder, FirstGenerationHasItsOwnKinds) {
  struct Case {
    std::uint8_t type;
    std::size_t bytes, records, echoes;
    std::initializer_list<LivoxBytes::Field> fields;
  };
  const Case cases[] = {
      {0, 13, 100, 1, {{1000, 4}, {2000, 4}, {-3000, 4}, {9, 1}}},
      {1, 9, 100, 1, {{5000, 4}, {9000, 2}, {9000, 2}, {9, 1}}},
      {2, 14, 96, 1, {{1000, 4}, {2000, 4}, {-3000, 4}, {9, 1}, {0, 1}}},
      {3, 10, 96, 1, {{5000, 4}, {9000, 2}, {9000, 2}, {9, 1}, {0, 1}}},
      {4,
       28,
       48,
       2,
       {{1000, 4}, {2000, 4}, {-3000, 4}, {9, 1}, {0, 1}, {1, 4}, {2, 4}, {3, 4}, {8, 1}, {0, 1}}},
      {5, 16, 48, 2, {{9000, 2}, {9000, 2}, {5000, 4}, {9, 1}, {0, 1}, {2000, 4}, {8, 1}, {0, 1}}},
      {7,
       42,
       30,
       3,
       {{1000, 4},
        {2000, 4},
        {-3000, 4},
        {9, 1},
        {0, 1},
        {1, 4},
        {2, 4},
        {3, 4},
        {8, 1},
        {0, 1},
        {4, 4},
        {5, 4},
        {6, 4},
        {7, 1},
        {0, 1}}},
      {8,
       22,
       30,
       3,
       {{9000, 2},
        {9000, 2},
        {5000, 4},
        {9, 1},
        {0, 1},
        {2000, 4},
        {8, 1},
        {0, 1},
        {1000, 4},
        {7, 1},
        {0, 1}}},
  };
  for (const Case& c : cases) {
    auto datagram = LivoxBytes::first(c.type, c.bytes, c.records);
    datagram.record(c.records - 1, c.fields);
    const auto packet = decode("livox_avia", datagram);
    ASSERT_EQ(packet.points.size(), c.echoes) << int{c.type};
    const bool spherical = c.type % 2 == 1 ? c.type != 7 : c.type == 8;
    if (spherical) {
      expect_point(packet.points[0], 0.0, 5.0, 0.0, 9);
    } else {
      expect_point(packet.points[0], 1.0, 2.0, -3.0, 9);
    }
    for (std::size_t k = 0; k < c.echoes; ++k) {
      EXPECT_EQ(packet.points[k].intensity, 9 - k);
      EXPECT_EQ(int{packet.points[k].echo}, k == 0 ? 0 : 1);
      EXPECT_EQ(packet.points[k].dt_ns, 0);
      EXPECT_EQ(packet.points[k].channel, (c.records - 1) % 6);
    }
    EXPECT_EQ(packet.return_mode, c.echoes == 3   ? ReturnMode::triple
                                  : c.echoes == 2 ? ReturnMode::dual
                                                  : ReturnMode::unknown);
    EXPECT_EQ(packet.duration, static_cast<int>(c.records - 1) * Nanoseconds(4167));
    EXPECT_FALSE(packet.counter);
  }
}

TEST(LivoxDecoder, ShotsAreSpreadFromTheFirstToTheLast) {
  auto datagram = LivoxBytes::second(1, 14, 96);
  for (const std::size_t shot : {0U, 1U, 95U})
    datagram.record(shot, {{1000, 4}, {0, 4}, {0, 4}, {1, 1}, {0, 1}});
  const auto packet = decode("livox_mid360", datagram);
  EXPECT_EQ(packet.duration, std::chrono::microseconds(475));
  EXPECT_EQ(packet.interval, std::chrono::microseconds(480));  // what real units keep
  EXPECT_EQ(packet.sensor_time, std::chrono::seconds(7) + std::chrono::microseconds(475));
  EXPECT_EQ(packet.points[0].dt_ns, -475'000);
  EXPECT_EQ(packet.points[1].dt_ns, -470'000);
  EXPECT_EQ(packet.points[2].dt_ns, 0);
  ASSERT_TRUE(packet.counter);
  EXPECT_EQ(packet.counter->value, 41U);
  EXPECT_EQ(packet.counter->wrap, 65'536U);
  EXPECT_FALSE(packet.zero_crossing);
  EXPECT_FALSE(packet.cut_azimuth);
  EXPECT_EQ(packet.rotation_rate, 0.0);
  EXPECT_EQ(packet.first_azimuth, 0.0);
  EXPECT_EQ(packet.last_azimuth, 0.0);

  datagram.put(3, 0, 2);  // not told
  EXPECT_EQ(decode("livox_mid360", datagram).duration, std::chrono::microseconds(475));
  auto one = LivoxBytes::second(1, 14, 1);
  one.record(0, {{1000, 4}, {0, 4}, {0, 4}, {1, 1}, {0, 1}});
  EXPECT_EQ(decode("livox_mid360", one).duration, Nanoseconds::zero());
  EXPECT_EQ(decode("livox_mid360", one).points.at(0).dt_ns, 0);
}

TEST(LivoxDecoder, DateStampsAreReadAndNonsenseStaysInBounds) {
  auto datagram = LivoxBytes::first(2, 14, 96);
  datagram.put(8, 3, 1);
  datagram.put(10, 24, 1);
  datagram.put(11, 2, 1);
  datagram.put(12, 29, 1);
  datagram.put(13, 23, 1);
  datagram.put(14, 1'500'000, 4);
  namespace ch = std::chrono;
  const auto date = ch::sys_days(ch::year(2024) / ch::February / 29) + ch::hours(23) + ch::milliseconds(1500);
  const auto packet = decode("livox_avia", datagram);
  EXPECT_EQ(packet.sensor_time - packet.duration, Nanoseconds(date.time_since_epoch()));

  datagram.put(12, 30, 1);
  EXPECT_EQ(decode("livox_avia", datagram).sensor_time, packet.duration);
  auto far = LivoxBytes::second(1, 14, 96);
  far.put(28, std::numeric_limits<std::uint64_t>::max(), 8);
  EXPECT_GT(decode("livox_mid360", far).sensor_time, Nanoseconds::zero());
}

TEST(LivoxDecoder, TellsWhatItsClockFollows) {
  const auto second = [](std::uint8_t type) {
    auto datagram = LivoxBytes::second(1, 14, 96);
    datagram.put(11, type, 1);
    return decode("livox_hap", datagram).clock_reference;
  };
  EXPECT_EQ(second(0), ClockReference::none);
  EXPECT_EQ(second(1), ClockReference::ptp);
  EXPECT_EQ(second(2), ClockReference::gps);
  EXPECT_EQ(second(3), ClockReference::unknown);
  const auto first = [](std::uint8_t type) {
    auto datagram = LivoxBytes::first(2, 14, 96);
    datagram.put(8, type, 1);
    return decode("livox_avia", datagram).clock_reference;
  };
  EXPECT_EQ(first(0), ClockReference::none);
  EXPECT_EQ(first(1), ClockReference::ptp);
  EXPECT_EQ(first(2), ClockReference::unknown);
  EXPECT_EQ(first(3), ClockReference::gps);
  EXPECT_EQ(first(4), ClockReference::pulse);
  EXPECT_EQ(first(255), ClockReference::unknown);
}

TEST(LivoxDecoder, TheImusDatagramsAreItsOwnAndHoldNoPoints) {
  auto mid360 = decoder_of("livox_mid360");
  auto avia = decoder_of("livox_avia");
  EXPECT_TRUE(mid360.inform(LivoxBytes::second(0, 24, 1).bytes));
  EXPECT_TRUE(avia.inform(LivoxBytes::first(6, 24, 1).bytes));
  EXPECT_FALSE(mid360.inform(LivoxBytes::first(6, 24, 1).bytes));
  EXPECT_FALSE(avia.inform(LivoxBytes::second(0, 24, 1).bytes));
  EXPECT_FALSE(mid360.inform(LivoxBytes::second(1, 14, 96).bytes)) << "points";
  EXPECT_FALSE(mid360.inform(LivoxBytes::second(0, 23, 1).bytes)) << "of another size";
  EXPECT_FALSE(mid360.inform(std::vector<std::uint8_t>(60, 0))) << "without its length";
  EXPECT_FALSE(mid360.inform({}));
}

TEST(LivoxDecoder, OnlyWhatTheManualCallsNoiseIsDropped) {
  for (int tag = 0; tag < 256; ++tag) {
    auto datagram = LivoxBytes::second(1, 14, 96);
    datagram.record(0, {{1000, 4}, {0, 4}, {0, 4}, {1, 1}, {tag, 1}});
    EXPECT_EQ(decode("livox_mid360", datagram).points.size(), 1U);
    EXPECT_EQ(decode("livox_hap", datagram).points.size(), tag % 4 == 1 ? 0U : 1U);
  }
  auto echoes = LivoxBytes::first(4, 28, 48);  // the farther one is noise: the other is the last
  echoes.record(0, {{6000, 4}, {0, 4}, {0, 4}, {1, 1}, {1, 1}, {4000, 4}, {0, 4}, {0, 4}, {2, 1}, {0, 1}});
  const auto points = decode("livox_avia", echoes).points;
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].echo, 0);
  EXPECT_EQ(points[0].intensity, 2);
}

TEST(LivoxDecoder, RefusalsNameWhatWasExpectedAndSeen) {
  const auto good = LivoxBytes::second(1, 14, 96);
  EXPECT_EQ(explanation_of("livox_mid360", good), "ok");
  auto cut = good;
  cut.bytes.resize(1379);
  EXPECT_EQ(explanation_of("livox_mid360", cut), "expected datagrams of 1380 bytes, saw 1379 bytes");
  cut.bytes.resize(35);
  EXPECT_EQ(explanation_of("livox_mid360", cut), "expected datagrams of 36 bytes, saw 35 bytes");
  auto length = good;
  length.put(1, 1400, 2);
  EXPECT_EQ(explanation_of("livox_mid360", length), "expected datagrams of 1400 bytes, saw 1380 bytes");
  auto dots = good;
  dots.put(5, 97, 2);
  EXPECT_EQ(explanation_of("livox_mid360", dots), "expected datagrams of 1394 bytes, saw 1380 bytes");
  EXPECT_EQ(explanation_of("livox_mid360", LivoxBytes::second(1, 14, 0)),
            "expected datagrams of 50 bytes, saw 36 bytes");
  EXPECT_EQ(explanation_of("livox_hap", LivoxBytes::second(4, 28, 48)),
            "expected a point data type of a Livox HAP, saw 0x04");
  EXPECT_EQ(explanation_of("livox_hap", LivoxBytes::first(2, 14, 96)),
            "expected protocol version 0 of a Livox HAP, saw 5");
  EXPECT_EQ(explanation_of("livox_avia", LivoxBytes::first(2, 14, 95)),
            "expected datagrams of 1362 bytes, saw 1348 bytes");
  auto angle = LivoxBytes::second(3, 10, 96);
  angle.record(5, {{5000, 4}, {18'001, 2}, {0, 2}, {1, 1}, {0, 1}});
  EXPECT_EQ(explanation_of("livox_mid360", angle), "expected angles up to 180 and 360 deg, saw 180.01 deg");
}

TEST(LivoxDecoder, DamagedDatagramsAreRefusedOrStayInBounds) {
  std::mt19937 random(5);
  const std::pair<const char*, LivoxBytes> all[] = {
      {"livox_mid360", LivoxBytes::second(1, 14, 96)}, {"livox_mid360", LivoxBytes::second(2, 8, 96)},
      {"livox_hap", LivoxBytes::second(3, 10, 96)},    {"livox_hap", LivoxBytes::second(0x11, 28, 48)},
      {"livox_avia", LivoxBytes::first(2, 14, 96)},    {"livox_avia", LivoxBytes::first(8, 22, 30)},
  };
  DecodedPacket packet;
  for (const auto& [model, clean] : all) {
    const auto decoder = decoder_of(model);
    for (std::size_t size = 0; size < clean.bytes.size(); ++size)
      EXPECT_FALSE(decoder.decode(Bytes(clean.bytes).first(size), packet).ok());
    for (int run = 0; run < 3'000; ++run) {
      auto bytes = clean.bytes;
      for (int i = 0; i < 60; ++i)
        bytes[bytes.size() - 1 - random() % (bytes.size() - 20)] ^=
            static_cast<std::uint8_t>(1U << random() % 8);
      if (!decoder.decode(bytes, packet).ok()) {
        EXPECT_TRUE(packet.points.empty());
        continue;
      }
      EXPECT_LE(packet.points.size(), 96U);
      for (const LidarPoint& point : packet.points) {
        EXPECT_LE(point.dt_ns, 0);
        EXPECT_GE(point.dt_ns, -packet.duration.count());
        EXPECT_LE(std::abs(point.x), 4.3e6F);  // 32 bits of millimetres
        EXPECT_LE(std::abs(point.y), 4.3e6F);
        EXPECT_LE(std::abs(point.z), 4.3e6F);
      }
    }
  }
}

}  // namespace
}  // namespace hulltrack
