// The decoder against packets written by hand: angles, times, echoes, jumps, refusals.
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/robosense/robosense_decoder.hpp"
#include "tests/support/robosense_bytes.hpp"

namespace hulltrack {
namespace {

using robosense::RobosenseDecoder;
using test::block_azimuths;
using test::classic_bytes;
using test::difop_bytes;
using test::helios_bytes;
using test::put_echo;
using test::RobosenseBytes;
using test::rs16_difop_bytes;

DecodedPacket decode(const char* model, const RobosenseBytes& difop, const RobosenseBytes& bytes,
                     const DecoderOptions& options = {}) {
  DecodedPacket packet;
  RobosenseDecoder decoder(*robosense::find_model(model), options);
  EXPECT_TRUE(decoder.inform(difop));
  EXPECT_EQ(decoder.decode(bytes, packet).status, DecodeStatus::ok);
  return packet;
}

DecodedPacket helios32(const RobosenseBytes& bytes, const DecoderOptions& options = {}) {
  return decode("robosense_helios32", difop_bytes(32, 4), bytes, options);
}

std::string explanation(const char* model, const RobosenseBytes& difop, const RobosenseBytes& bytes) {
  DecodedPacket packet;
  RobosenseDecoder decoder(*robosense::find_model(model), {});
  EXPECT_TRUE(difop.empty() || decoder.inform(difop));
  return decoder.explain(decoder.decode(bytes, packet));
}

/// Where the formula of FORMAT.md puts a return: angles in deg, lengths in m.
void expect_at(const LidarPoint& point, double d, double elevation, double h, double dh, double rx,
               double rz) {
  const double v = radians(elevation);
  EXPECT_NEAR(point.x, d * std::cos(v) * std::cos(radians(h + dh)) + rx * std::cos(radians(h)), 1e-5);
  EXPECT_NEAR(point.y, -d * std::cos(v) * std::sin(radians(h + dh)) - rx * std::sin(radians(h)), 1e-5);
  EXPECT_NEAR(point.z, d * std::sin(v) + rz, 1e-5);
}

TEST(RobosenseDecoder, TablesAreTheMakers) {
  struct Entry {
    const char* model;
    RobosenseBytes difop;
    bool helios;
    int step;  // 0.01 deg a block at 600 rpm
    std::size_t slot;
    int channel;
    double elevation, dh, unit, rx, rz, time_us, span_us;
  };
  const auto table32 = difop_bytes(32, 1);
  const auto rs16 = rs16_difop_bytes(1);
  const auto bpearl = test::bpearl_difop_bytes(1);
  const Entry entries[] = {
      {"robosense_helios32", difop_bytes(32, 4), true, 20, 31, 31, -21, .5, .0025, .03498, 0, 53.63, 55.56},
      {"robosense_helios16p", difop_bytes(16, 4), true, 40, 15, 15, -5, .5, .0025, .03498, 0, 43.91, 111.12},
      {"robosense_helios16p", difop_bytes(16, 4), true, 40, 20, 4, 6, -.5, .0025, .03498, 0, 68.82, 111.12},
      {"robosense_rs16", rs16, false, 40, 15, 15, 7.5, 0, .005, .03825, 0, 42.0, 111.0},
      {"robosense_rs16", rs16, false, 40, 16, 0, -7.5, 0, .005, .03825, 0, 55.5, 111.0},
      {"robosense_rs32", table32, false, 20, 14, 14, -4, -.5, .005, .03997, 0, 40.32, 55.52},
      {"robosense_rs32", table32, false, 20, 15, 15, -5, .5, .005, .03997, 0, 44.64, 55.52},
      {"robosense_rs32", table32, false, 20, 30, 30, -20, -.5, .005, .03997, 0, 41.76, 55.52},
      {"robosense_rs32", table32, false, 20, 31, 31, -21, .5, .005, .03997, 0, 46.08, 55.52},
      {"robosense_bpearl", bpearl, false, 20, 8, 8, 72, -.5, .005, .01473, .09427, 25.68, 55.52},
      {"robosense_bpearl", bpearl, false, 20, 17, 17, 54, .5, .005, .01473, .09427, 3.84, 55.52},
      {"robosense_bpearl", bpearl, false, 20, 31, 31, 26, .5, .005, .01473, .09427, 44.88, 55.52},
  };
  for (const Entry& e : entries) {
    SCOPED_TRACE(std::string(e.model) + " slot " + std::to_string(e.slot));
    const auto azimuths = block_azimuths(9000, e.step);
    auto bytes = e.helios ? helios_bytes(azimuths) : classic_bytes(azimuths);
    put_echo(bytes, 1, e.slot, 4000, 77);
    const auto packet = decode(e.model, e.difop, bytes);
    ASSERT_EQ(packet.points.size(), 1U);
    const LidarPoint& point = packet.points[0];
    const double h = 0.01 * (azimuths[1] + std::floor(e.step * e.time_us / e.span_us));
    expect_at(point, 4000 * e.unit, e.elevation, h, e.dh, e.rx, e.rz);
    EXPECT_EQ(point.channel, e.channel);
    EXPECT_EQ(point.intensity, 77);
    EXPECT_EQ(point.echo, 0);
    const auto after_first = (packet.duration + Nanoseconds(point.dt_ns)).count();
    EXPECT_EQ(after_first, std::llround(1000 * (e.span_us + e.time_us)));
  }
}

TEST(RobosenseDecoder, AzimuthWrapsInsideABlock) {
  auto bytes = helios_bytes(block_azimuths(35990, 20));
  put_echo(bytes, 0, 0, 4000);
  put_echo(bytes, 0, 30, 4000);  // 18.68 of 20 on
  const auto packet = helios32(bytes);
  expect_at(packet.points.at(0), 10.0, 10, 359.90, -0.5, 0.03498, 0);
  expect_at(packet.points.at(1), 10.0, -20, 0.08, -0.5, 0.03498, 0);
}

TEST(RobosenseDecoder, LastBlockGoesOnByTheSetRateWhileTheRotorKeepsToIt) {
  for (const auto& [rpm, step] : {std::pair{600, 20}, std::pair{1200, 20}}) {
    auto azimuths = block_azimuths(1000, step);
    azimuths[11] += 4;  // scatter, not a new rate
    auto bytes = helios_bytes(azimuths);
    put_echo(bytes, 11, 30, 4000);
    const auto packet = decode("robosense_helios32", difop_bytes(32, 4, rpm), bytes);
    expect_at(packet.points.at(0), 10.0, -20, 0.01 * (azimuths[11] + 18), -0.5, 0.03498, 0);
  }
}

TEST(RobosenseDecoder, WithoutFiringCorrectionABlockHasOneAzimuth) {
  auto bytes = helios_bytes(block_azimuths(1000, 20));
  put_echo(bytes, 3, 31, 4000);
  expect_at(helios32(bytes, {.firing_correction = false}).points.at(0), 10.0, -21, 10.60, 0.5, 0.03498, 0);
}

TEST(RobosenseDecoder, NothingIsInterpolatedAcrossAJump) {
  auto azimuths = block_azimuths(1000, 20);
  for (std::size_t b = 6; b < 12; ++b) azimuths[b] = 20000 + 20 * static_cast<int>(b - 6);
  auto bytes = helios_bytes(azimuths);
  put_echo(bytes, 5, 30, 4000);
  put_echo(bytes, 6, 30, 4000);
  const auto packet = helios32(bytes);
  ASSERT_EQ(packet.points.size(), 2U);
  expect_at(packet.points[0], 10.0, -20, 11.18, -0.5, 0.03498, 0);
  ASSERT_TRUE(packet.cut_azimuth);
  EXPECT_NEAR(degrees(*packet.cut_azimuth), 11.0, 1e-9);
  // 189 deg at 0.2 deg a period of 55.56 us.
  EXPECT_NEAR(packet.points[1].dt_ns - packet.points[0].dt_ns, 945 * 55'560, 1);
}

TEST(RobosenseDecoder, AJumpMayLieBetweenTheTwoFiringsOfABlock) {
  auto azimuths = block_azimuths(1000, 40);
  for (std::size_t b = 6; b < 12; ++b) azimuths[b] = 20020 + 40 * static_cast<int>(b - 6);
  auto bytes = helios_bytes(azimuths);
  for (const std::size_t block : {4U, 5U, 6U}) {
    put_echo(bytes, block, 15, 4000);
    put_echo(bytes, block, 20, 4000);  // second firing
  }
  const auto packet = decode("robosense_helios16p", difop_bytes(16, 4), bytes);
  ASSERT_EQ(packet.points.size(), 5U);  // block 5: only the first firing
  EXPECT_EQ(packet.points[2].channel, 15);
  EXPECT_EQ(packet.points[3].channel, 15);
  expect_at(packet.points[2], 10.0, -5, 12.00 + 0.15, 0.5, 0.03498, 0);
  ASSERT_TRUE(packet.cut_azimuth);
  EXPECT_NEAR(degrees(*packet.cut_azimuth), 12.0, 1e-9);
}

TEST(RobosenseDecoder, StandingStillIsNotAJump) {
  auto azimuths = block_azimuths(1000, 0);
  azimuths[4] = 999;  // the encoder's last digit flickers
  const auto packet = helios32(helios_bytes(azimuths));
  EXPECT_FALSE(packet.cut_azimuth);
  EXPECT_EQ(packet.rotation_rate, 0.0);
}

TEST(RobosenseDecoder, ReportsRotationAndWhenTheRotorPassedZero) {
  const auto packet = helios32(helios_bytes(block_azimuths(35950, 20)));
  ASSERT_TRUE(packet.zero_crossing);
  EXPECT_NEAR(static_cast<double>((packet.duration + *packet.zero_crossing).count()), 2.5 * 55'560, 1.0);
  EXPECT_NEAR(packet.rotation_rate, radians(0.2) / 55.56e-6, 1e-6);
  EXPECT_NEAR(degrees(packet.first_azimuth), 359.5, 1e-9);
  EXPECT_NEAR(degrees(packet.last_azimuth), 1.7 + 0.2 * 53.63 / 55.56, 1e-9);
  EXPECT_EQ(packet.duration.count(), 11 * 55'560 + 53'630);
  EXPECT_EQ(packet.interval.count(), 12 * 55'560);
  EXPECT_FALSE(helios32(helios_bytes(block_azimuths(100, 20))).zero_crossing);
}

TEST(RobosenseDecoder, SensorTimeIsThatOfTheLastFiring) {
  auto bytes = helios_bytes(block_azimuths(0, 20));
  test::put_be16(bytes, 24, 1000);  // seconds, low half
  test::put_be16(bytes, 28, 7);     // microseconds
  auto packet = helios32(bytes);
  EXPECT_EQ(packet.sensor_time, std::chrono::seconds(1000) + std::chrono::microseconds(7) + packet.duration);

  bytes = classic_bytes(block_azimuths(0, 20));
  bytes[22] = 2;  // 2024-01-02
  bytes[23] = 3;  // h
  bytes[24] = 4;  // min
  bytes[25] = 5;  // s
  bytes[27] = 6;  // ms
  bytes[29] = 7;  // us
  packet = decode("robosense_rs32", difop_bytes(32, 1), bytes);
  const std::chrono::seconds second(1'704'067'200 + 86'400 + 3 * 3600 + 4 * 60 + 5);
  EXPECT_EQ(packet.sensor_time,
            second + std::chrono::milliseconds(6) + std::chrono::microseconds(7) + packet.duration);
}

TEST(RobosenseDecoder, CountsDatagramsWhereTheModelDoes) {
  const auto count = [](const char* model, const RobosenseBytes& difop, RobosenseBytes bytes) {
    for (std::size_t i = 0; i < 4; ++i) bytes[12 + i] = static_cast<std::uint8_t>(i + 1);
    return decode(model, difop, bytes).counter;
  };
  const auto helios = count("robosense_helios32", difop_bytes(32, 4), helios_bytes(block_azimuths(0, 20)));
  ASSERT_TRUE(helios);
  EXPECT_EQ(helios->value, 0x01020304U);
  EXPECT_EQ(helios->wrap, std::uint64_t{1} << 32);
  const auto azimuths = block_azimuths(0, 20);
  EXPECT_TRUE(count("robosense_bpearl", test::bpearl_difop_bytes(1), classic_bytes(azimuths)));
  EXPECT_FALSE(count("robosense_rs32", difop_bytes(32, 1), classic_bytes(azimuths))) << "reserved";
}

TEST(RobosenseDecoder, PairsOfBlocksHoldTwoEchoes) {
  auto bytes = helios_bytes(block_azimuths(1000, 20, 2));
  put_echo(bytes, 2, 17, 6000);
  put_echo(bytes, 3, 17, 5000);  // another echo
  put_echo(bytes, 2, 18, 4000);
  put_echo(bytes, 3, 18, 4000);  // the same echo again
  put_echo(bytes, 3, 19, 3000);  // without a partner
  // The pairs themselves say so: the DIFOP packet may be from before the setting was changed.
  for (const auto mode : {std::uint8_t{0}, std::uint8_t{4}}) {
    const auto packet = decode("robosense_helios32", difop_bytes(32, mode), bytes);
    EXPECT_EQ(packet.return_mode, ReturnMode::dual);
    ASSERT_EQ(packet.points.size(), 4U);
    EXPECT_EQ(packet.points[0].echo, 0);
    EXPECT_EQ(packet.points[2].echo, 1);
    EXPECT_EQ(packet.points[2].dt_ns, packet.points[0].dt_ns);
    expect_at(packet.points[2], 12.5, -7, 0.01 * (1020 + 10), 0.5, 0.03498, 0);
    EXPECT_EQ(packet.points[3].echo, 0);
    EXPECT_EQ(packet.duration.count(), 5 * 55'560 + 53'630);
  }
  const DecoderOptions all = {.repeated_echoes = true};
  EXPECT_EQ(decode("robosense_helios32", difop_bytes(32, 0), bytes, all).points.size(), 5U);

  const auto single = helios_bytes(block_azimuths(1000, 20));
  EXPECT_EQ(decode("robosense_helios32", difop_bytes(32, 0), single).return_mode, ReturnMode::unknown);
  EXPECT_EQ(decode("robosense_helios32", difop_bytes(32, 5), single).return_mode, ReturnMode::last);
  EXPECT_EQ(decode("robosense_helios32", difop_bytes(32, 6), single).return_mode, ReturnMode::first);
  // Nothing turns: equal azimuths tell nothing.
  const auto still = helios_bytes(block_azimuths(1000, 0));
  EXPECT_EQ(decode("robosense_helios32", difop_bytes(32, 4), still).return_mode, ReturnMode::strongest);
  EXPECT_EQ(decode("robosense_helios32", difop_bytes(32, 0), still).return_mode, ReturnMode::dual);
}

TEST(RobosenseDecoder, SixteenLasersHoldTheSecondEchoInTheSecondHalf) {
  auto bytes = classic_bytes(block_azimuths(1000, 20));
  put_echo(bytes, 2, 5, 6000);
  put_echo(bytes, 2, 21, 5000);
  put_echo(bytes, 2, 6, 4000);
  put_echo(bytes, 2, 22, 4000);
  const auto packet = decode("robosense_rs16", rs16_difop_bytes(0), bytes);
  EXPECT_EQ(packet.return_mode, ReturnMode::dual);
  ASSERT_EQ(packet.points.size(), 3U);
  EXPECT_EQ(packet.points[2].channel, 5);
  EXPECT_EQ(packet.points[2].echo, 1);
  EXPECT_EQ(packet.points[2].dt_ns, packet.points[0].dt_ns);
  expect_at(packet.points[2], 25.0, -2.5, 10.40 + 0.05, 0, 0.03825, 0);
  EXPECT_EQ(packet.interval.count(), 12 * 55'500);
}

TEST(RobosenseDecoder, SixteenLasersOfAnotherReturnModeThanToldAreHeldBack) {
  EXPECT_EQ(explanation("robosense_rs16", rs16_difop_bytes(1), classic_bytes(block_azimuths(0, 20))),
            "expected steps of 0.40 deg by the DIFOP packet's return mode and speed, saw 0.20 deg, those of "
            "another return mode");
  EXPECT_NE(explanation("robosense_rs16", rs16_difop_bytes(0), classic_bytes(block_azimuths(0, 40))), "ok");
  EXPECT_EQ(explanation("robosense_rs16", rs16_difop_bytes(9), classic_bytes(block_azimuths(0, 40))),
            "expected a return mode that the model has, saw 0x09");
}

TEST(RobosenseDecoder, RefusalsNameWhatWasExpectedAndSeen) {
  const auto good = helios_bytes(block_azimuths(0, 20));
  const auto difop = difop_bytes(32, 4);
  const char* model = "robosense_helios32";
  EXPECT_EQ(explanation(model, difop, good), "ok");
  EXPECT_EQ(explanation(model, {}, good),
            "expected the unit's DIFOP packet first, saw none yet: its lasers' angles are not known");
  auto flag = good;
  flag[743] = 0xEF;
  EXPECT_EQ(explanation(model, difop, flag), "expected block flag 0xFFEE, saw 0xFFEF");
  EXPECT_EQ(explanation(model, difop, classic_bytes(block_azimuths(0, 20))),
            "expected packet id 0x55AA055A, saw 0x55AA050A");
  EXPECT_EQ(explanation("robosense_rs32", difop, good), "expected packet id 0x55AA050A, saw 0x55AA055A");
  auto azimuths = block_azimuths(0, 20);
  azimuths[7] = 36000;
  EXPECT_EQ(explanation(model, difop, helios_bytes(azimuths)),
            "expected the azimuths of a turning sensor, saw 360.00 deg");
  EXPECT_NE(explanation(model, difop, helios_bytes(block_azimuths(0, 80))), "ok");  // 2,400 rpm
}

TEST(RobosenseDecoder, EverySizeIsRefusedButTheRightOne) {
  const auto good = helios_bytes(block_azimuths(0, 20));
  RobosenseDecoder decoder(*robosense::find_model("robosense_helios32"), {});
  ASSERT_TRUE(decoder.inform(difop_bytes(32, 4)));
  DecodedPacket packet;
  for (std::size_t size = 0; size <= 1300; ++size) {
    RobosenseBytes bytes(size, 0xFF);
    std::copy_n(good.begin(), std::min(size, good.size()), bytes.begin());
    EXPECT_EQ(decoder.decode(bytes, packet).ok(), size == 1248);
    EXPECT_FALSE(decoder.inform(bytes));
  }
}

}  // namespace
}  // namespace hulltrack
