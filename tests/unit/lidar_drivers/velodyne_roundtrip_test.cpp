// Encoder and decoder invert each other: four models, three return modes, several rotation rates.
#include <gtest/gtest.h>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/velodyne/velodyne_decoder.hpp"
#include "tests/support/velodyne_stream.hpp"

namespace hulltrack {
namespace {

struct Case {
  const char* model;
  ReturnMode mode;
  double rpm;
};

class VelodyneRoundTrip : public testing::TestWithParam<Case> {};

TEST_P(VelodyneRoundTrip, EveryReturnComesBackWhereAndWhenItWasFired) {
  test::StreamOptions options;
  options.model = GetParam().model;
  options.encoder.return_mode = GetParam().mode;
  options.encoder.rpm = GetParam().rpm;
  options.encoder.start_azimuth = 6.1;
  options.encoder.utc = std::chrono::seconds(3599) + std::chrono::milliseconds(990);  // wraps on the way
  options.packets = 300;
  const auto stream = test::make_stream(options);
  const velodyne::ModelTable& table = *velodyne::find_model(GetParam().model);
  const velodyne::VelodyneDecoder decoder(table, {.repeated_echoes = true});

  const int steps = GetParam().mode == ReturnMode::dual ? 5 : 11;
  const double rate_error =
      radians(0.011) / to_seconds(steps * table.block_period);  // first and last are rounded

  std::size_t next = 0;
  DecodedPacket packet;
  for (const auto& sent : stream.packets) {
    ASSERT_TRUE(decoder.decode(sent.bytes, packet).ok());
    EXPECT_EQ(packet.return_mode, GetParam().mode);
    EXPECT_FALSE(packet.cut_azimuth);
    EXPECT_NEAR(packet.rotation_rate, radians(GetParam().rpm * 6.0), rate_error);
    for (const LidarPoint& point : packet.points) {
      ASSERT_LT(next, stream.returns.size());
      const test::TrueReturn& truth = stream.returns[next++];
      const double turn_error =
          radians(0.016);  // block azimuths are rounded to 0.01 deg, the last step extrapolated
      const double allowed = truth.range * turn_error + 0.5 * table.distance_unit + 1e-5;
      const Eigen::Vector3d seen(point.x, point.y, point.z);
      ASSERT_LE((seen - truth.point).norm(), allowed) << "return " << next - 1;
      EXPECT_EQ(sent.last_firing + Nanoseconds(point.dt_ns), truth.time);
      EXPECT_EQ(point.channel, truth.channel);
      EXPECT_EQ(point.intensity, truth.intensity);
    }
  }
  EXPECT_EQ(next, stream.returns.size());
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* model : {"velodyne_vlp16", "velodyne_puck_hires", "velodyne_hdl32e", "velodyne_vlp32c"}) {
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

INSTANTIATE_TEST_SUITE_P(Models, VelodyneRoundTrip, testing::ValuesIn(cases()), case_name);

TEST(VelodyneEncoder, PacketRateIsTheManuals) {
  // VLP-16 manual: 754 packets/s single, 1508 dual; VLP-32C: 1507 single; HDL-32E: 1808 single.
  const auto rate = [](const char* model, ReturnMode mode) {
    auto encoder = sim::VelodyneEncoder::create(model, {.return_mode = mode});
    return 1.0 / to_seconds(encoder->packet_interval());
  };
  EXPECT_NEAR(rate("velodyne_vlp16", ReturnMode::strongest), 753.5, 0.5);
  EXPECT_NEAR(rate("velodyne_vlp16", ReturnMode::dual), 1507.0, 1.0);
  EXPECT_NEAR(rate("velodyne_vlp32c", ReturnMode::strongest), 1507.0, 1.0);
  EXPECT_NEAR(rate("velodyne_hdl32e", ReturnMode::strongest), 1808.4, 1.0);
}

TEST(VelodyneEncoder, RefusesUnknownModelsAndImpossibleRates) {
  EXPECT_FALSE(sim::VelodyneEncoder::create("velodyne_vlp17", {}).ok());
  EXPECT_FALSE(sim::VelodyneEncoder::create("velodyne_vlp16", {.rpm = 0.0}).ok());
  EXPECT_FALSE(sim::VelodyneEncoder::create("velodyne_vlp16", {.rpm = 1e9}).ok());
}

TEST(VelodyneEncoder, RangesThatTheFormatCannotHoldBecomeNoReturn) {
  auto encoder = sim::VelodyneEncoder::create("velodyne_vlp16", {});
  std::vector<sim::LaserReturn> returns(encoder->firings_per_packet(), {131.08, 7});  // 65,540 units of 2 mm
  returns[5] = {131.07, 9};
  const auto bytes = encoder->encode(0, returns);
  const velodyne::VelodyneDecoder decoder(*velodyne::find_model("velodyne_vlp16"), {});
  DecodedPacket packet;
  ASSERT_TRUE(decoder.decode(bytes, packet).ok());
  ASSERT_EQ(packet.points.size(), 1U);
  EXPECT_EQ(packet.points[0].intensity, 9);
}

TEST(ModelRegistry, EveryModelMakesItsDecoderAndHasItsOwnName) {
  for (const LidarModel& model : lidar_models()) {
    EXPECT_EQ(find_lidar_model(model.name), &model);
    const bool needs_file = model.calibration == LidarModel::Calibration::required;
    EXPECT_EQ(make_lidar_decoder(model, {}, {}).ok(), !needs_file) << model.name;
    EXPECT_NE(model.port, 0) << model.name;
  }
  EXPECT_EQ(find_lidar_model("velodyne"), nullptr);
}

}  // namespace
}  // namespace hulltrack
