#include "lidar_drivers/recognition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lidar_drivers/sim/encoder_registry.hpp"

namespace hulltrack {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

/// Tenth of a second of a sensor that sees nothing but a wall at 10 m.
void hear(Recognition& recognition, std::string_view model, ReturnMode mode = ReturnMode::strongest) {
  const auto encoder = sim::make_lidar_encoder(model, {.return_mode = mode}).value();
  const LidarModel& row = *find_lidar_model(model);
  const auto datagram = [&](const std::vector<std::uint8_t>& bytes, std::uint16_t port, Nanoseconds sent) {
    const std::int64_t utc = 1'767'251'400'000'000'000 + sent.count();
    recognition.add({.bytes = bytes,
                     .received = measurement_time_from_ns(utc),
                     .received_utc = WallTime{Nanoseconds(utc)},
                     .source_ip = 0xC0A801C9,
                     .source_port = port,
                     .destination_port = port});
  };
  const std::size_t echoes = mode == ReturnMode::dual ? 2 : 1;
  for (std::uint64_t n = 0; encoder->first_firing(n) < std::chrono::milliseconds(100); ++n) {
    datagram(
        encoder->encode(n, std::vector<sim::LaserReturn>(echoes * encoder->firings_per_packet(), {10.0, 50})),
        row.port, encoder->last_firing(n));
    if (n == 20 && row.information_port != 0)
      datagram(encoder->information().datagram, row.information_port, encoder->last_firing(n));
  }
}

std::vector<std::string> names(const Recognition& recognition) {
  std::vector<std::string> all;
  for (const auto& candidate : recognition.candidates()) all.emplace_back(candidate.model->name);
  return all;
}

TEST(Recognition, KnowsEveryModelThatCanBeImitated) {
  int models = 0;
  for (const LidarModel& model : lidar_models()) {
    if (!sim::make_lidar_encoder(model.name, {})) continue;
    ++models;
    Recognition recognition;
    hear(recognition, model.name);
    EXPECT_THAT(names(recognition), Contains(std::string(model.name)));
    EXPECT_EQ(recognition.traffic().front().port, model.port);
  }
  EXPECT_GE(models, 8);
}

TEST(Recognition, TellsRateReturnModeAndClockOfWhatItDecodes) {
  Recognition recognition;
  hear(recognition, "hesai_xt32", ReturnMode::dual);
  ASSERT_THAT(names(recognition), ::testing::ElementsAre("hesai_xt32"));
  const LidarStatus status = recognition.candidates().front().status;
  EXPECT_EQ(status.return_mode, ReturnMode::dual);
  EXPECT_NEAR(status.rpm, 600.0, 1.0);
  EXPECT_FALSE(status.clock.believed()) << "it counts from 1970";
}

TEST(Recognition, ARoboSensesDifopTellsTheNumberOfItsLasers) {
  Recognition recognition;
  hear(recognition, "robosense_helios16p");
  EXPECT_THAT(names(recognition), ::testing::ElementsAre("robosense_helios16p"));
}

TEST(Recognition, OfAnOusterItNeedsTheMetadata) {
  Recognition recognition;
  hear(recognition, "ouster_os");
  ASSERT_THAT(names(recognition), ::testing::ElementsAre("ouster_os"));
  EXPECT_TRUE(recognition.candidates().front().shape_alone);
}

TEST(Recognition, OtherTrafficIsNoLidar) {
  Recognition recognition;
  EXPECT_THAT(recognition.candidates(), IsEmpty());
  const std::vector<std::uint8_t> bytes(1206, 7);
  for (int i = 0; i < 50; ++i) recognition.add({.bytes = bytes, .destination_port = 2368});
  EXPECT_THAT(recognition.candidates(), IsEmpty());
  EXPECT_EQ(recognition.traffic().front().sizes.at(1206), 50U);
}

TEST(Recognition, AFewOfASensorsDatagramsAmongOtherTrafficAreNoVerdict) {
  Recognition recognition;
  hear(recognition, "velodyne_vlp16");
  const std::vector<std::uint8_t> bytes(300, 7);
  for (int i = 0; i < 1000; ++i) recognition.add({.bytes = bytes, .destination_port = 2368});
  EXPECT_THAT(recognition.candidates(), IsEmpty());
}

}  // namespace
}  // namespace hulltrack
