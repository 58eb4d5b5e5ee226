// Encoder and decoder invert each other: every model that can be played, three return modes, several rates.
#include <gtest/gtest.h>

#include <random>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/robosense/robosense_format.hpp"
#include "lidar_drivers/sim/encoder_registry.hpp"
#include "lidar_drivers/sim/robosense_encoder.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

struct Case {
  const char* model;
  ReturnMode mode;
  double rpm;
};

class RobosenseRoundTrip : public testing::TestWithParam<Case> {};

/// As the wire has them: of each firing of all lasers first the first echoes, then the second ones.
std::vector<std::size_t> wire_order(std::size_t firings, std::size_t lasers, std::size_t echoes) {
  std::vector<std::size_t> order;
  for (std::size_t group = 0; group < firings; group += lasers) {
    for (std::size_t echo = 0; echo < echoes; ++echo) {
      for (std::size_t k = 0; k < lasers; ++k) order.push_back((group + k) * echoes + echo);
    }
  }
  return order;
}

TEST_P(RobosenseRoundTrip, EveryReturnComesBackWhereAndWhenItWasFired) {
  const robosense::ModelTable& table = *robosense::find_model(GetParam().model);
  const bool dual = GetParam().mode == ReturnMode::dual;
  const std::size_t echoes = dual ? 2 : 1;
  const Nanoseconds start = std::chrono::seconds(1'700'000'000) + std::chrono::microseconds(999'990);
  const auto encoder = sim::make_lidar_encoder(
      table.name,
      {.return_mode = GetParam().mode, .rpm = GetParam().rpm, .start_azimuth = 6.1, .utc = start});
  ASSERT_TRUE(encoder.ok());
  const auto decoder = make_lidar_decoder(*find_lidar_model(table.name), {.repeated_echoes = true}, {});
  ASSERT_TRUE(decoder.ok());
  ASSERT_TRUE((*decoder)->inform((*encoder)->information().datagram));

  std::mt19937 random(1);
  std::uniform_int_distribution<int> range_mm(500, 90'000);
  std::uniform_int_distribution<int> percent(0, 99);
  std::vector<sim::LaserFiring> firings;
  std::vector<sim::LaserReturn> returns;
  DecodedPacket packet;
  for (std::uint64_t n = 0; n < 300; ++n) {
    (*encoder)->firings(n, firings);
    returns.clear();
    for (std::size_t i = 0; i < firings.size() * echoes; ++i) {
      returns.push_back(
          {percent(random) < 80 ? range_mm(random) * 1e-3 : 0.0, static_cast<std::uint8_t>(percent(random))});
    }
    const auto outcome = (*decoder)->decode((*encoder)->encode(n, returns), packet);
    ASSERT_TRUE(outcome.ok()) << (*decoder)->explain(outcome);
    EXPECT_EQ(packet.return_mode, GetParam().mode);
    EXPECT_FALSE(packet.cut_azimuth);
    EXPECT_EQ(packet.duration, (*encoder)->packet_duration());
    EXPECT_EQ(packet.interval, (*encoder)->packet_interval());
    // The clock counts whole microseconds.
    EXPECT_LE(start + (*encoder)->last_firing(n) - packet.sensor_time, std::chrono::microseconds(1));
    EXPECT_GE(start + (*encoder)->last_firing(n) - packet.sensor_time, Nanoseconds::zero());
    std::size_t next = 0;
    for (const std::size_t i : wire_order(firings.size(), table.lasers, echoes)) {
      const sim::LaserReturn& hit = returns[i];
      const sim::LaserFiring& firing = firings[i / echoes];
      if (hit.range == 0.0) continue;
      ASSERT_LT(next, packet.points.size());
      const LidarPoint& point = packet.points[next++];
      // Azimuths are rounded to 0.01 deg, the last step to that again, and the sum is truncated.
      const double allowed =
          (hit.range + table.lens_forward) * radians(0.021) + 0.5 * table.distance_unit + 1e-5;
      const Eigen::Vector3d fired = firing.origin + hit.range * firing.direction;
      ASSERT_LE((Eigen::Vector3d(point.x, point.y, point.z) - fired).norm(), allowed) << "packet " << n;
      ASSERT_EQ((*encoder)->last_firing(n) + Nanoseconds(point.dt_ns), firing.time);
      ASSERT_EQ(point.channel, firing.channel);
      ASSERT_EQ(point.intensity, hit.intensity);
    }
    EXPECT_EQ(next, packet.points.size());
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* model : {"robosense_rs16", "robosense_helios32", "robosense_helios16p"}) {
    for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::last, ReturnMode::dual}) {
      for (const double rpm : {300.0, 600.0, 1200.0}) all.push_back({model, mode, rpm});
    }
  }
  return all;
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  return std::string(info.param.model) + "_" + return_mode_name(info.param.mode) + "_" +
         std::to_string(static_cast<int>(info.param.rpm));
}

INSTANTIATE_TEST_SUITE_P(Models, RobosenseRoundTrip, testing::ValuesIn(cases()), case_name);

TEST(RobosenseEncoder, ItsInformationIsACalibrationFile) {
  const test::TempFolder folder;
  for (const char* model : {"robosense_rs16", "robosense_helios32", "robosense_helios16p"}) {
    const auto encoder = sim::make_lidar_encoder(model, {});
    ASSERT_TRUE(encoder.ok());
    const auto information = (*encoder)->information();
    const auto file = folder.file(information.calibration_name, information.calibration);
    EXPECT_TRUE(make_lidar_decoder(*find_lidar_model(model), {}, file).ok()) << model;
  }
}

TEST(RobosenseEncoder, PacketRateIsTheMakers) {
  // Helios: 150 packets a turn of 0.1 s with 32 lasers and one return, twice as many with two; half with 16.
  const auto rate = [](const char* model, ReturnMode mode) {
    return 1.0 / to_seconds(sim::make_lidar_encoder(model, {.return_mode = mode}).value()->packet_interval());
  };
  EXPECT_NEAR(rate("robosense_helios32", ReturnMode::strongest), 1500.0, 1.0);
  EXPECT_NEAR(rate("robosense_helios32", ReturnMode::dual), 3000.0, 1.0);
  EXPECT_NEAR(rate("robosense_helios16p", ReturnMode::last), 750.0, 1.0);
  EXPECT_NEAR(rate("robosense_helios16p", ReturnMode::dual), 1500.0, 1.0);
}

TEST(RobosenseEncoder, RefusesWhatItCannotPlay) {
  EXPECT_FALSE(sim::make_lidar_encoder("robosense_helios", {}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("robosense_bpearl", {}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("robosense_rs32", {}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("robosense_rs16", {.rpm = 0.0}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("robosense_rs16", {.rpm = 1e9}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("robosense_rs16", {.return_mode = ReturnMode::first}).ok());
}

}  // namespace
}  // namespace hulltrack
