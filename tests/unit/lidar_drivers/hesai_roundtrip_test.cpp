// Encoder and decoder invert each other: four models, three return modes, several rotation rates.
#include <gtest/gtest.h>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/sim/hesai_encoder.hpp"
#include "tests/support/lidar_stream.hpp"

namespace hulltrack {
namespace {

struct Case {
  const char* model;
  ReturnMode mode;
  double rpm;
};

class HesaiRoundTrip : public testing::TestWithParam<Case> {};

TEST_P(HesaiRoundTrip, EveryReturnComesBackWhereAndWhenItWasFired) {
  const hesai::ModelTable& table = *hesai::find_model(GetParam().model);
  test::StreamOptions options;
  options.model = GetParam().model;
  options.slots = table.lasers;
  options.encoder.return_mode = GetParam().mode;
  options.encoder.rpm = GetParam().rpm;
  options.encoder.start_azimuth = 6.1;
  options.encoder.utc = std::chrono::seconds(1'735'689'599) + std::chrono::milliseconds(990);  // end of 2024
  options.packets = 300;
  const auto stream = test::make_stream(options);
  const auto decoder = make_lidar_decoder(*find_lidar_model(options.model), {.repeated_echoes = true}, {});
  ASSERT_TRUE(decoder.ok());
  const double unit = table.distance_unit_mm * 0.001;

  std::size_t next = 0;
  std::uint64_t number = 0;
  double newest_azimuth = 0.0;
  std::size_t crossings = 0;
  DecodedPacket packet;
  for (const auto& sent : stream.packets) {
    ASSERT_TRUE(decoder.value()->decode(sent.bytes, packet).ok());
    EXPECT_EQ(packet.return_mode, GetParam().mode);
    EXPECT_FALSE(packet.cut_azimuth);
    EXPECT_NEAR(packet.rotation_rate, radians(GetParam().rpm * 6.0), 1e-9);
    EXPECT_EQ(packet.counter->value, number++);
    const Nanoseconds clock = options.encoder.utc + (sent.last_firing - options.start);
    EXPECT_LE(packet.sensor_time, clock);
    EXPECT_GT(packet.sensor_time, clock - std::chrono::microseconds(1));
    const bool between = number > 1 && packet.first_azimuth < newest_azimuth - 3.0;
    crossings += packet.zero_crossing || between ? 1U : 0U;
    newest_azimuth = packet.last_azimuth;
    for (const LidarPoint& point : packet.points) {
      ASSERT_LT(next, stream.returns.size());
      const test::TrueReturn& truth = stream.returns[next++];
      // A block's azimuth is rounded to 0.01 deg, the rest of the turn is known.
      const double allowed = truth.range * radians(0.0051) + 0.5 * unit + 1e-5;
      ASSERT_LE((Eigen::Vector3d(point.x, point.y, point.z) - truth.point).norm(), allowed) << next - 1;
      EXPECT_EQ(sent.last_firing + Nanoseconds(point.dt_ns), truth.time);
      EXPECT_EQ(point.channel, truth.channel);
      EXPECT_EQ(point.intensity, truth.intensity);
    }
  }
  EXPECT_EQ(next, stream.returns.size());
  const double turned =
      6.1 + to_seconds(stream.packets.back().last_firing - options.start) * radians(GetParam().rpm * 6.0);
  EXPECT_EQ(crossings, static_cast<std::size_t>(turned / (2.0 * std::numbers::pi)));
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* model : {"hesai_xt16", "hesai_xt32", "hesai_xt32m", "hesai_qt64"}) {
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

INSTANTIATE_TEST_SUITE_P(Models, HesaiRoundTrip, testing::ValuesIn(cases()), case_name);

TEST(HesaiEncoder, DatagramsAreOfTheManualsSizeAndRate) {
  // PandarXT: 2,500 datagrams a second single, 5,000 dual.
  const auto xt = sim::HesaiEncoder::create("hesai_xt32", {});
  EXPECT_EQ(xt->packet_interval(), std::chrono::microseconds(400));
  EXPECT_EQ(xt->encode(0, std::vector<sim::LaserReturn>(256)).size(), 1080U);
  const auto dual = sim::HesaiEncoder::create("hesai_xt32", {.return_mode = ReturnMode::dual});
  EXPECT_EQ(dual->packet_interval(), std::chrono::microseconds(200));
  EXPECT_EQ(dual->firings_per_packet(), 128U);
  EXPECT_EQ(sim::HesaiEncoder::create("hesai_xt16", {})->encode(0, std::vector<sim::LaserReturn>(128)).size(),
            568U);
  EXPECT_EQ(
      sim::HesaiEncoder::create("hesai_xt32m", {})->encode(0, std::vector<sim::LaserReturn>(192)).size(),
      820U);
  EXPECT_EQ(sim::HesaiEncoder::create("hesai_qt64", {})->encode(0, std::vector<sim::LaserReturn>(256)).size(),
            1072U);
}

TEST(HesaiEncoder, RefusesModelsAndRatesThatItCannotImitate) {
  EXPECT_FALSE(sim::HesaiEncoder::create("hesai_xt33", {}).ok());
  EXPECT_FALSE(sim::HesaiEncoder::create("hesai_pandar40p", {}).ok());
  EXPECT_FALSE(sim::HesaiEncoder::create("hesai_xt32", {.return_mode = ReturnMode::triple}).ok());
  EXPECT_FALSE(sim::HesaiEncoder::create("hesai_xt32", {.rpm = 0.0}).ok());
  EXPECT_FALSE(sim::HesaiEncoder::create("hesai_xt32", {.rpm = 1e9}).ok());
}

TEST(HesaiEncoder, RangesThatTheFormatCannotHoldBecomeNoReturn) {
  const auto encoder = sim::HesaiEncoder::create("hesai_xt32", {});
  std::vector<sim::LaserReturn> returns(encoder->firings_per_packet(), {262.2, 7});  // 65,550 units of 4 mm
  returns[5] = {262.14, 9};
  const auto decoder = make_lidar_decoder(*find_lidar_model("hesai_xt32"), {}, {});
  DecodedPacket packet;
  ASSERT_TRUE(decoder.value()->decode(encoder->encode(0, returns), packet).ok());
  ASSERT_EQ(packet.points.size(), 1U);
  EXPECT_EQ(packet.points[0].intensity, 9);
}

}  // namespace
}  // namespace hulltrack
