// The decoder against datagrams written by hand from the manuals: angles, times, returns, jumps.
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/se3.hpp"
#include "tests/support/hesai_decode.hpp"

namespace hulltrack {
namespace {

using test::decode;
using test::hesai_azimuths;
using test::hesai_bytes;
using test::hesai_model;
using test::HesaiBytes;
using test::HesaiModel;
using test::put_return;
using test::refusal;

const HesaiModel& kXt32 = hesai_model("hesai_xt32");
constexpr Nanoseconds kTailTime = std::chrono::seconds(1'680'674'828) + std::chrono::milliseconds(500);

double azimuth_deg(const LidarPoint& point) {
  const double azimuth = degrees(std::atan2(-point.y, point.x));
  return azimuth < 0.0 ? azimuth + 360.0 : azimuth;
}

double elevation_deg(const LidarPoint& point) {
  return degrees(std::atan2(point.z, std::hypot(point.x, point.y)));
}

TEST(HesaiDecoder, AxesAreForwardLeftUp) {
  auto bytes = hesai_bytes(kXt32, hesai_azimuths(kXt32, 9000, 0));
  put_return(bytes, kXt32, 0, 0, 2500);  // +15 deg, 10 m, azimuth 90 deg: to the right
  const auto point = decode(kXt32, bytes, {.firing_correction = false}).points.at(0);
  EXPECT_NEAR(point.x, 0.0, 1e-5);
  EXPECT_NEAR(point.y, -10.0 * std::cos(radians(15.0)), 1e-5);
  EXPECT_NEAR(point.z, 10.0 * std::sin(radians(15.0)), 1e-5);
}

/// What the manuals say of one laser: angles at design, pulse after the block's reference, unit of distance.
struct Entry {
  const char* model;
  std::size_t laser;
  double elevation, azimuth;
  std::int64_t pulse_ns;
  double unit;
};
const Entry kEntries[] = {
    {"hesai_xt16", 0, 15, 0, 368, 0.004},
    {"hesai_xt16", 15, -15, 0, 368 + 15 * 3024, 0.004},
    {"hesai_xt32", 31, -16, 0, 368 + 31 * 1512, 0.004},
    {"hesai_xt32m", 17, -2.6, 0, 368 + 2888, 0.005},
    {"hesai_pandar40p", 6, 1.67, 3.125, -47'460, 0.004},
    {"hesai_pandar40p", 39, -25, -1.042, -3'620, 0.004},
    {"hesai_pandar64", 8, 1.522, 5.208, -7'532, 0.004},
    {"hesai_pandar64", 39, -3.712, -5.208, -54'668, 0.004},
    {"hesai_qt64", 0, -52.121, 8.736, 2'310, 0.004},
    {"hesai_qt64", 63, 52.133, -7.892, 136'450, 0.004},
};

TEST(HesaiDecoder, TablesAreTheManuals) {
  for (const Entry& e : kEntries) {
    SCOPED_TRACE(std::string(e.model) + " laser " + std::to_string(e.laser));
    const HesaiModel& model = hesai_model(e.model);
    const double period = model.name == "hesai_qt64" ? 166'667 : model.year_base == 2000 ? 55'560 : 50'000;
    const int step = static_cast<int>(std::lround(3600.0 * period * 1e-9 * 100.0));
    auto bytes = hesai_bytes(model, hesai_azimuths(model, 1000, step));
    put_return(bytes, model, 1, e.laser, 2500);
    const auto packet = decode(model, bytes);
    ASSERT_EQ(packet.points.size(), 1U);
    const LidarPoint& point = packet.points[0];
    const double turned = 3600.0 * static_cast<double>(e.pulse_ns) * 1e-9;
    EXPECT_NEAR(elevation_deg(point), e.elevation, 1e-4);
    EXPECT_NEAR(azimuth_deg(point), 10.0 + step * 0.01 + e.azimuth + turned, 1e-4);
    EXPECT_NEAR(std::hypot(point.x, point.y, point.z), 2500 * e.unit, 1e-5);
    EXPECT_EQ(point.channel, e.laser);
    EXPECT_EQ(point.intensity, 50);
    EXPECT_NEAR(packet.rotation_rate, radians(3600.0), 1e-9);

    // Against the block's azimuth the correction is all that differs.
    const auto plain = decode(model, bytes, {.firing_correction = false});
    EXPECT_NEAR(azimuth_deg(plain.points.at(0)), 10.0 + step * 0.01 + e.azimuth, 1e-4);
    EXPECT_EQ(plain.points[0].dt_ns, point.dt_ns);
  }
}

TEST(HesaiDecoder, TimesAreThoseOfTheManuals) {
  // Last pulse after the datagram's time, first pulse to last one, datagram to datagram; single return.
  struct Times {
    const char* model;
    std::int64_t last, duration, interval;
  };
  const Times all[] = {
      {"hesai_xt16", 5632 + 368 + 15 * 3024, 7 * 50'000 + 15 * 3024, 400'000},
      {"hesai_xt32", 5632 + 368 + 31 * 1512, 7 * 50'000 + 31 * 1512, 400'000},
      {"hesai_xt32m", 5632 + 368 + 15 * 2888, 5 * 50'000 + 15 * 2888, 300'000},
      {"hesai_pandar40p", -28'580 - 3'620, 9 * 55'560 + 54'670 - 3'620, 555'600},
      {"hesai_pandar64", -42'580 - 3'620, 5 * 55'560 + 54'668 - 3'620, 333'360},
      {"hesai_qt64", 25'710 + 3 * 166'667 + 136'450, 3 * 166'667 + 136'450 - 2'310, 4 * 166'667},
  };
  for (const Times& t : all) {
    SCOPED_TRACE(t.model);
    const HesaiModel& model = hesai_model(t.model);
    auto bytes = hesai_bytes(model, hesai_azimuths(model, 0, 20));
    for (int k = 0; k < model.lasers; ++k) put_return(bytes, model, 0, static_cast<std::size_t>(k), 999);
    put_return(bytes, model, static_cast<std::size_t>(model.blocks - 1), 3, 999);
    const auto packet = decode(model, bytes);
    EXPECT_EQ((packet.sensor_time - kTailTime).count(), t.last);
    EXPECT_EQ(packet.duration.count(), t.duration);
    EXPECT_EQ(packet.interval.count(), t.interval);
    const auto earliest = std::ranges::min(packet.points, {}, &LidarPoint::dt_ns);
    EXPECT_EQ(earliest.dt_ns, -t.duration);
    ASSERT_TRUE(packet.counter);
    EXPECT_EQ(packet.counter->value, 77U);
    EXPECT_EQ(packet.counter->wrap, std::uint64_t{1} << 32);
    EXPECT_EQ(test::hesai_decoder(model)->clock_wrap(), Nanoseconds::zero());
  }
}

TEST(HesaiDecoder, ADateThatIsNoneLeavesAClockThatRuns) {
  auto bytes = hesai_bytes(kXt32, hesai_azimuths(kXt32, 0, 18));
  const Nanoseconds last = decode(kXt32, bytes).sensor_time - kTailTime;
  bytes[kXt32.date + 1] = 2;  // 30 February
  bytes[kXt32.date + 2] = 30;
  const Nanoseconds of_day =
      std::chrono::hours(6) + std::chrono::minutes(7) + std::chrono::milliseconds(8500);
  EXPECT_EQ(decode(kXt32, bytes).sensor_time, of_day + last);
  for (std::size_t i = 0; i < 6; ++i) bytes[kXt32.date + i] = 255;
  test::put_le(bytes, kXt32.microseconds, 0xFFFFFFFF, 4);
  EXPECT_GT(decode(kXt32, bytes).sensor_time, Nanoseconds::zero());

  const HesaiModel& far = hesai_model("hesai_pandar64");  // its years reach furthest
  auto late = hesai_bytes(far, hesai_azimuths(far, 0, 20));
  const int date[] = {255, 12, 31, 255, 255, 255};
  for (std::size_t i = 0; i < 6; ++i) late[far.date + i] = static_cast<std::uint8_t>(date[i]);
  EXPECT_GT(decode(far, late).sensor_time, std::chrono::hours(24 * 365 * 285));
}

TEST(HesaiDecoder, TheFartherOfTwoReturnsIsTheLastWhereverItStands) {
  for (const bool farther_first : {true, false}) {
    auto bytes = hesai_bytes(kXt32, hesai_azimuths(kXt32, 1000, 18, 2), 0x39);
    put_return(bytes, kXt32, 2, 17, farther_first ? 6000 : 5000, 10);
    put_return(bytes, kXt32, 3, 17, farther_first ? 5000 : 6000, 90);
    put_return(bytes, kXt32, 2, 18, 4000, 11);
    put_return(bytes, kXt32, 3, 18, 4000, 11);  // the same return again
    put_return(bytes, kXt32, 3, 19, 3000, 12);  // without a partner
    const auto service = decode(kXt32, bytes);
    ASSERT_EQ(service.points.size(), 4U);
    EXPECT_EQ(service.return_mode, ReturnMode::dual);
    EXPECT_EQ(service.points[0].echo, farther_first ? 0 : 1);
    EXPECT_EQ(service.points[2].echo, farther_first ? 1 : 0);
    EXPECT_EQ(service.points[2].dt_ns, service.points[0].dt_ns);
    EXPECT_EQ(service.points[1].echo, 0);
    EXPECT_EQ(service.points[3].echo, 0);
    const auto all = decode(kXt32, bytes, {.repeated_echoes = true});
    ASSERT_EQ(all.points.size(), 5U);
    EXPECT_EQ(all.points[1].echo + all.points[3].echo, 1);  // of the two alike one is the last
  }
  auto azimuths = hesai_azimuths(kXt32, 1000, 18, 2);
  ++azimuths[3];
  EXPECT_EQ(refusal(kXt32, hesai_bytes(kXt32, azimuths, 0x39)),
            "expected the azimuths of a turning sensor, saw 10.19 deg");
}

TEST(HesaiDecoder, OfThreeReturnsTheFarthestIsTheLast) {
  const HesaiModel& model = hesai_model("hesai_xt32m");
  auto bytes = hesai_bytes(model, hesai_azimuths(model, 1000, 18, 3), 0x3D);
  put_return(bytes, model, 3, 4, 1000);
  put_return(bytes, model, 4, 4, 3000);
  put_return(bytes, model, 5, 4, 1000);  // the first return is the strongest one
  const auto packet = decode(model, bytes);
  EXPECT_EQ(packet.return_mode, ReturnMode::triple);
  ASSERT_EQ(packet.points.size(), 2U);
  EXPECT_EQ(packet.points[0].echo, 1);
  EXPECT_EQ(packet.points[1].echo, 0);
  EXPECT_EQ(packet.interval, std::chrono::microseconds(100));
}

TEST(HesaiDecoder, EachReturnModeHasItsName) {
  const std::pair<std::uint8_t, ReturnMode> modes[] = {
      {0x33, ReturnMode::first}, {0x37, ReturnMode::strongest}, {0x38, ReturnMode::last},
      {0x39, ReturnMode::dual},  {0x3B, ReturnMode::dual},      {0x3C, ReturnMode::dual}};
  for (const auto& [code, mode] : modes) {
    const int same = mode == ReturnMode::dual ? 2 : 1;
    EXPECT_EQ(decode(kXt32, hesai_bytes(kXt32, hesai_azimuths(kXt32, 0, 18, same), code)).return_mode, mode);
  }
}

TEST(HesaiDecoder, NothingIsInterpolatedAcrossAJump) {
  auto azimuths = hesai_azimuths(kXt32, 1000, 18);
  for (std::size_t b = 5; b < 8; ++b) azimuths[b] = 20000 + 18 * static_cast<int>(b - 5);
  auto bytes = hesai_bytes(kXt32, azimuths);
  put_return(bytes, kXt32, 4, 31, 2500);
  put_return(bytes, kXt32, 5, 31, 2500);
  const auto packet = decode(kXt32, bytes);
  ASSERT_TRUE(packet.cut_azimuth);
  EXPECT_NEAR(degrees(*packet.cut_azimuth), 10.72, 1e-9);
  EXPECT_NEAR(azimuth_deg(packet.points.at(0)), 10.72 + 3600.0 * 47.24e-6, 1e-4);
  // 189.28 deg at 3600 deg/s.
  EXPECT_NEAR(packet.points.at(1).dt_ns - packet.points[0].dt_ns, 189.28 / 3600.0 * 1e9, 1.0);
}

TEST(HesaiDecoder, AJumpBetweenTheOnlyTwoGroupsIsTimedByTheMotor) {
  const HesaiModel& model = hesai_model("hesai_xt32m");
  auto bytes = hesai_bytes(model, hesai_azimuths(model, 1000, 9000, 3), 0x3D);
  const auto packet = decode(model, bytes);
  ASSERT_TRUE(packet.cut_azimuth);
  EXPECT_NEAR(packet.rotation_rate, radians(3600.0), 1e-9);
  EXPECT_NEAR(static_cast<double>(packet.duration.count()), 90.0 / 3600.0 * 1e9 + 15 * 2888, 1.0);
  test::put_le(bytes, model.motor, 0, 2);
  EXPECT_EQ(refusal(model, bytes), "expected the azimuths of a turning sensor, saw 90.00 deg");
}

TEST(HesaiDecoder, AMotorSpeedThatContradictsTheAzimuthsIsNotBelieved) {
  for (const int rpm : {0, 1200, 65535}) {
    const auto packet = decode(kXt32, hesai_bytes(kXt32, hesai_azimuths(kXt32, 0, 18), 0x37, rpm));
    EXPECT_NEAR(packet.rotation_rate, radians(3600.0), 1e-9) << rpm;
  }
  const auto still = decode(kXt32, hesai_bytes(kXt32, hesai_azimuths(kXt32, 1000, 0), 0x37, 600));
  EXPECT_EQ(still.rotation_rate, 0.0);
  EXPECT_FALSE(still.cut_azimuth);
}

TEST(HesaiDecoder, ReportsWhenTheRotorPassedZero) {
  const auto packet = decode(kXt32, hesai_bytes(kXt32, hesai_azimuths(kXt32, 35955, 18)));
  ASSERT_TRUE(packet.zero_crossing);
  EXPECT_EQ((packet.duration + *packet.zero_crossing).count(), 125'000 - 368);  // 2.5 blocks
  EXPECT_FALSE(decode(kXt32, hesai_bytes(kXt32, hesai_azimuths(kXt32, 100, 18))).zero_crossing);

  // A Pandar40P's block counts from its end: here the rotor passed zero on the way to the first one.
  const HesaiModel& model = hesai_model("hesai_pandar40p");
  const auto early = decode(model, hesai_bytes(model, hesai_azimuths(model, 10, 20)));
  ASSERT_TRUE(early.zero_crossing);
  EXPECT_NEAR(static_cast<double>((early.duration + *early.zero_crossing).count()),
              54'670 - 0.1 / 3600.0 * 1e9, 10.0);
  EXPECT_NEAR(degrees(early.first_azimuth), 360.0 + 0.1 - 3600.0 * 54.67e-6, 1e-6);
}

}  // namespace
}  // namespace hulltrack
