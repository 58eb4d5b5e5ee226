// Encoder and decoder invert each other, through the metadata that the encoder gives out.
#include <gtest/gtest.h>

#include <random>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/ouster/ouster_decoder.hpp"
#include "lidar_drivers/sim/encoder_registry.hpp"

namespace hulltrack {
namespace {

constexpr Nanoseconds kUtc = std::chrono::seconds(1'700'000'000);

std::unique_ptr<const sim::LidarEncoder> encoder_of(const sim::LidarEncoderConfig& config) {
  auto encoder = sim::make_lidar_encoder("ouster_os", config);
  EXPECT_TRUE(encoder.ok());
  return std::move(encoder).value();
}

ouster::OusterDecoder decoder_of(const sim::LidarEncoder& encoder) {
  const sim::SensorInformation information = encoder.information();
  EXPECT_EQ(information.calibration_name, "metadata.json");
  return {ouster::parse_metadata(information.calibration, information.calibration_name).value(), {}};
}

class OusterRoundTrip : public testing::TestWithParam<std::tuple<ReturnMode, double>> {};

TEST_P(OusterRoundTrip, EveryReturnComesBackWhereAndWhenItWasFired) {
  const auto [mode, rpm] = GetParam();
  const bool dual = mode == ReturnMode::dual;
  const auto encoder = encoder_of({.return_mode = mode, .rpm = rpm, .start_azimuth = 6.1, .utc = kUtc});
  const auto decoder = decoder_of(*encoder);
  std::mt19937 random(1);
  std::uniform_int_distribution<int> range_mm(500, 90'000);
  std::vector<sim::LaserFiring> firings;
  DecodedPacket packet;
  int turns = 0;
  for (std::uint64_t n = 0; n < 70; ++n) {
    encoder->firings(n, firings);
    ASSERT_EQ(firings.size(), encoder->firings_per_packet());
    std::vector<sim::LaserReturn> returns;
    struct Sent {
      std::size_t firing;
      sim::LaserReturn hit;
      int echo;
    };
    std::vector<Sent> sent;
    for (std::size_t i = 0; i < firings.size(); ++i) {
      const sim::LaserReturn last{random() % 5 == 0 ? 0.0 : range_mm(random) * 1e-3,
                                  static_cast<std::uint8_t>(random() % 256)};
      const bool two = dual && random() % 3 == 0 && last.range > 0.0;
      const sim::LaserReturn other{two ? last.range - 0.3 : last.range, last.intensity};
      returns.push_back(last);
      if (dual) returns.push_back(other);
      if (two) sent.push_back({i, other, 1});
      if (last.range > 0.0) sent.push_back({i, last, 0});
    }
    ASSERT_TRUE(decoder.decode(encoder->encode(n, returns), packet).ok());
    EXPECT_EQ(packet.return_mode, mode);
    EXPECT_EQ(packet.duration, encoder->packet_duration());
    EXPECT_EQ(packet.sensor_time, kUtc + encoder->last_firing(n));
    EXPECT_NEAR(to_seconds(packet.interval), to_seconds(encoder->packet_interval()), 2e-9);
    const double rate = radians(rpm * 6.0);
    const double rounded = 1e-9 / to_seconds(packet.duration);  // stamps are whole nanoseconds
    EXPECT_NEAR(packet.rotation_rate, rate, 1.1 * rounded * rate);
    ASSERT_TRUE(packet.counter);
    EXPECT_EQ(packet.counter->value, 62 + n);  // 6.1 rad is in datagram 62 of 64
    if (packet.zero_crossing) ++turns;
    ASSERT_EQ(packet.points.size(), sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) {
      const LidarPoint& point = packet.points[i];
      const sim::LaserFiring& firing = firings[sent[i].firing];
      const Eigen::Vector3d truth = firing.origin + sent[i].hit.range * firing.direction;
      ASSERT_LE((Eigen::Vector3d(point.x, point.y, point.z) - truth).norm(), 1e-5);
      EXPECT_EQ(encoder->last_firing(n) + Nanoseconds(point.dt_ns), firing.time);
      EXPECT_EQ(point.channel, firing.channel);
      EXPECT_EQ(point.intensity, sent[i].hit.intensity);
      EXPECT_EQ(int{point.echo}, sent[i].echo);
    }
  }
  EXPECT_EQ(turns, 2);  // after 2 and 66 datagrams
}

INSTANTIATE_TEST_SUITE_P(Modes, OusterRoundTrip,
                         testing::Combine(testing::Values(ReturnMode::strongest, ReturnMode::dual),
                                          testing::Values(600.0, 1200.0)));

TEST(OusterEncoder, FiringsSayTheirOwnAngles) {
  std::vector<sim::LaserFiring> firings;
  encoder_of({.start_azimuth = 1.0})->firings(5, firings);
  for (const sim::LaserFiring& firing : firings) {
    EXPECT_NEAR(firing.direction.x(), std::cos(firing.elevation) * std::cos(firing.azimuth), 1e-12);
    EXPECT_NEAR(firing.direction.y(), -std::cos(firing.elevation) * std::sin(firing.azimuth), 1e-12);
    EXPECT_NEAR(firing.direction.z(), std::sin(firing.elevation), 1e-12);
  }
}

TEST(OusterEncoder, RefusesWhatTheSensorCannotBeSetTo) {
  EXPECT_FALSE(sim::make_lidar_encoder("ouster_dome", {}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("ouster_os", {.rpm = 300.0}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("ouster_os", {.return_mode = ReturnMode::last}).ok());
}

TEST(OusterEncoder, RangesThatTheFormatCannotHoldBecomeNoReturn) {
  const auto encoder = encoder_of({});
  std::vector<sim::LaserReturn> returns(encoder->firings_per_packet(), {524.288, 7});
  returns[3] = {0.0004, 8};
  returns[5] = {524.287, 9};
  DecodedPacket packet;
  ASSERT_TRUE(decoder_of(*encoder).decode(encoder->encode(0, returns), packet).ok());
  ASSERT_EQ(packet.points.size(), 1U);
  EXPECT_EQ(packet.points[0].intensity, 9);
}

}  // namespace
}  // namespace hulltrack
