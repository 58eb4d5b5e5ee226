// The decoder against packets written by hand from the manuals: angles, times, pairs, jumps, bad bytes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/velodyne/velodyne_decoder.hpp"
#include "tests/support/velodyne_bytes.hpp"

namespace hulltrack {
namespace {

using test::even_azimuths;
using test::put_return;
using test::velodyne_bytes;

DecodedPacket decode(const test::VelodyneBytes& bytes, const char* model = "velodyne_vlp16",
                     const DecoderOptions& options = {.vertical_offset = false}) {
  DecodedPacket packet;
  const velodyne::VelodyneDecoder decoder(*velodyne::find_model(model), options);
  EXPECT_EQ(decoder.decode(bytes, packet).status, DecodeStatus::ok);
  return packet;
}

DecodeOutcome outcome_of(const test::VelodyneBytes& bytes) {
  DecodedPacket packet;
  return velodyne::VelodyneDecoder(*velodyne::find_model("velodyne_vlp16"), {}).decode(bytes, packet);
}

std::string explanation_of(const test::VelodyneBytes& bytes) {
  DecodedPacket packet;
  const velodyne::VelodyneDecoder decoder(*velodyne::find_model("velodyne_vlp16"), {});
  return decoder.explain(decoder.decode(bytes, packet));
}

double azimuth_deg(const LidarPoint& point) {
  const double azimuth = degrees(std::atan2(-point.y, point.x));
  return azimuth < 0.0 ? azimuth + 360.0 : azimuth;
}

double elevation_deg(const LidarPoint& point) {
  return degrees(std::atan2(point.z, std::hypot(point.x, point.y)));
}

/// Azimuth of the only point of a packet with one return.
double azimuth_of(const test::VelodyneBytes& azimuths, std::size_t block, std::size_t slot,
                  const DecoderOptions& options = {.vertical_offset = false}) {
  auto bytes = azimuths;
  put_return(bytes, block, slot, 5000);
  const auto packet = decode(bytes, "velodyne_vlp16", options);
  EXPECT_EQ(packet.points.size(), 1U);
  return azimuth_deg(packet.points.at(0));
}

TEST(VelodyneDecoder, AxesAreForwardLeftUp) {
  auto bytes = velodyne_bytes(even_azimuths(9000, 0));
  put_return(bytes, 0, 15, 5000);  // +15 deg, 10 m, azimuth 90 deg: to the right
  const auto point = decode(bytes).points.at(0);
  EXPECT_NEAR(point.x, 0.0, 1e-5);
  EXPECT_NEAR(point.y, -10.0 * std::cos(radians(15.0)), 1e-5);
  EXPECT_NEAR(point.z, 10.0 * std::sin(radians(15.0)), 1e-5);
}

TEST(VelodyneDecoder, TablesAreTheManuals) {
  struct Entry {
    const char* model;
    std::uint8_t product;
    std::size_t slot;
    double elevation, azimuth, range;
    int channel;
    std::int64_t time_ns;
  };
  const Entry entries[] = {
      {"velodyne_vlp16", 0x22, 0, -15, 0, 10, 0, 0},
      {"velodyne_vlp16", 0x22, 1, 1, 0, 10, 1, 2304},
      {"velodyne_vlp16", 0x22, 30, -1, 0, 10, 14, 55296 + 14 * 2304},
      {"velodyne_puck_hires", 0x24, 7, 4.667, 0, 10, 7, 7 * 2304},
      {"velodyne_hdl32e", 0x21, 0, -30.67, 0, 10, 0, 0},
      {"velodyne_hdl32e", 0x21, 31, 10.67, 0, 10, 31, 31 * 1152},
      {"velodyne_vlp32c", 0x28, 0, -25, 1.4, 20, 0, 0},
      {"velodyne_vlp32c", 0x28, 1, -1, 360 - 4.2, 20, 1, 0},
      {"velodyne_vlp32c", 0x28, 3, -15.639, 360 - 1.4, 20, 3, 2304},
      {"velodyne_vlp32c", 0x28, 29, 15, 360 - 1.4, 20, 29, 14 * 2304},
  };
  for (const Entry& e : entries) {
    auto bytes = velodyne_bytes(even_azimuths(0, 0), 0, 0x37, e.product);
    put_return(bytes, 0, e.slot, 5000);
    const auto packet = decode(bytes, e.model);
    ASSERT_EQ(packet.points.size(), 1U);
    const LidarPoint& point = packet.points[0];
    EXPECT_NEAR(elevation_deg(point), e.elevation, 1e-4) << e.model << " slot " << e.slot;
    EXPECT_NEAR(std::remainder(azimuth_deg(point) - e.azimuth, 360.0), 0.0, 1e-4)
        << e.model << " slot " << e.slot;
    EXPECT_NEAR(std::hypot(point.x, point.y, point.z), e.range, 1e-5);
    EXPECT_EQ(point.channel, e.channel);
    EXPECT_EQ(packet.duration.count() + point.dt_ns, e.time_ns);
  }
}

TEST(VelodyneDecoder, AzimuthRunsEvenlyToTheNextBlock) {
  // Laser 0 of the second firing sequence: 55.296 of 110.592 us after the block's azimuth.
  EXPECT_NEAR(azimuth_of(velodyne_bytes(even_azimuths(1000, 40)), 3, 16), 11.20 + 0.20, 1e-4);
}

TEST(VelodyneDecoder, AzimuthWrapsInsideABlock) {
  const auto bytes = velodyne_bytes(even_azimuths(35990, 40));
  EXPECT_NEAR(azimuth_of(bytes, 0, 16), 0.10, 1e-4);
  EXPECT_NEAR(azimuth_of(bytes, 0, 0), 359.90, 1e-4);
}

TEST(VelodyneDecoder, LastBlockGoesOnAsTheOneBefore) {
  auto azimuths = even_azimuths(1000, 40);
  azimuths[11] = azimuths[10] + 42;
  EXPECT_NEAR(azimuth_of(velodyne_bytes(azimuths), 11, 16), azimuths[11] * 0.01 + 0.21, 1e-4);
}

TEST(VelodyneDecoder, WithoutFiringCorrectionABlockHasOneAzimuth) {
  const auto bytes = velodyne_bytes(even_azimuths(1000, 40));
  EXPECT_NEAR(azimuth_of(bytes, 3, 31, {.firing_correction = false, .vertical_offset = false}), 11.20, 1e-4);
}

TEST(VelodyneDecoder, NothingIsInterpolatedAcrossAJump) {
  auto azimuths = even_azimuths(1000, 40);
  for (std::size_t block = 6; block < 12; ++block) azimuths[block] = 20000 + 40 * static_cast<int>(block - 6);
  auto bytes = velodyne_bytes(azimuths);
  EXPECT_NEAR(azimuth_of(bytes, 5, 16), 12.00 + 0.20, 1e-4);

  put_return(bytes, 5, 0, 5000);
  put_return(bytes, 6, 0, 5000);
  const auto packet = decode(bytes);
  ASSERT_TRUE(packet.cut_azimuth);
  EXPECT_NEAR(degrees(*packet.cut_azimuth), 12.0, 1e-9);
  // 188 deg at 0.4 deg a block period of 110.592 us.
  EXPECT_NEAR(packet.points[1].dt_ns - packet.points[0].dt_ns, 470 * 110'592, 1);
}

TEST(VelodyneDecoder, StandingStillIsNotAJump) {
  auto azimuths = even_azimuths(1000, 0);
  azimuths[4] = 999;  // the encoder's last digit flickers
  const auto packet = decode(velodyne_bytes(azimuths));
  EXPECT_FALSE(packet.cut_azimuth);
  EXPECT_EQ(packet.rotation_rate, 0.0);
}

TEST(VelodyneDecoder, ReportsWhenTheRotorPassedZero) {
  const auto packet = decode(velodyne_bytes(even_azimuths(35900, 40)));
  ASSERT_TRUE(packet.zero_crossing);
  EXPECT_NEAR(static_cast<double>((packet.duration + *packet.zero_crossing).count()), 2.5 * 110'592, 1.0);
  EXPECT_FALSE(decode(velodyne_bytes(even_azimuths(100, 40))).zero_crossing);
}

TEST(VelodyneDecoder, SensorTimeIsThatOfTheLastFiringAndWrapsWithTheHour) {
  const auto packet = decode(velodyne_bytes(even_azimuths(0, 40), 3'599'999'000));
  EXPECT_EQ(packet.sensor_time, packet.duration - std::chrono::milliseconds(1));
}

TEST(VelodyneDecoder, DualReturnPairsShareTimeAndAzimuth) {
  std::array<int, 12> azimuths{};
  for (std::size_t block = 0; block < 12; ++block) azimuths[block] = 1000 + 40 * static_cast<int>(block / 2);
  auto bytes = velodyne_bytes(azimuths, 0, 0x39);
  put_return(bytes, 2, 17, 6000, 10);  // last
  put_return(bytes, 3, 17, 5000, 90);  // strongest, another echo
  put_return(bytes, 2, 18, 4000, 11);
  put_return(bytes, 3, 18, 4000, 11);  // the same echo again
  put_return(bytes, 3, 19, 3000, 12);  // without a partner
  const auto service = decode(bytes);
  ASSERT_EQ(service.points.size(), 4U);
  EXPECT_EQ(service.points[0].echo, 0);
  EXPECT_EQ(service.points[2].echo, 1);
  EXPECT_EQ(service.points[2].dt_ns, service.points[0].dt_ns);
  EXPECT_NEAR(azimuth_deg(service.points[2]), azimuth_deg(service.points[0]), 1e-4);
  EXPECT_EQ(service.points[3].echo, 0);
  EXPECT_EQ(decode(bytes, "velodyne_vlp16", {.repeated_echoes = true}).points.size(), 5U);

  azimuths[3] += 1;
  EXPECT_EQ(outcome_of(velodyne_bytes(azimuths, 0, 0x39)).status, DecodeStatus::bad_azimuth);
}

TEST(VelodyneDecoder, RefusalsNameWhatWasExpectedAndSeen) {
  auto good = velodyne_bytes(even_azimuths(0, 40));
  EXPECT_TRUE(outcome_of(good).ok());

  auto cut = good;
  cut.resize(1205);
  EXPECT_EQ(explanation_of(cut), "expected datagrams of 1206 bytes, saw 1205 bytes");
  auto flag = good;
  flag[700] = 0xDD;
  EXPECT_EQ(explanation_of(flag), "expected block flag 0xEEFF, saw 0xEEDD");
  EXPECT_EQ(explanation_of(velodyne_bytes(even_azimuths(0, 40), 0, 0x37, 0x28)),
            "expected VLP-16 (product code 0x22), saw VLP-32C (product code 0x28)");
  EXPECT_EQ(explanation_of(velodyne_bytes(even_azimuths(0, 40), 0, 0x3A)),
            "expected return mode 0x37, 0x38 or 0x39, saw 0x3A");
  auto azimuths = even_azimuths(0, 40);
  azimuths[7] = 36000;
  EXPECT_EQ(outcome_of(velodyne_bytes(azimuths)).status, DecodeStatus::bad_azimuth);
  EXPECT_EQ(outcome_of(velodyne_bytes(even_azimuths(0, 500))).status,
            DecodeStatus::bad_azimuth);  // 7,500 rpm
}

TEST(VelodyneDecoder, EverySizeIsRefusedButTheRightOne) {
  const auto good = velodyne_bytes(even_azimuths(0, 40));
  test::VelodyneBytes bytes;
  for (std::size_t size = 0; size <= 1300; ++size) {
    bytes.assign(size, 0xFF);
    std::copy_n(good.begin(), std::min(size, good.size()), bytes.begin());
    EXPECT_EQ(outcome_of(bytes).ok(), size == 1206);
  }
}

TEST(VelodyneDecoder, FlippedBitsNeverLeadOutOfBounds) {
  std::mt19937 random(7);
  auto clean = velodyne_bytes(even_azimuths(35000, 40), 12345, 0x39);
  for (std::size_t i = 0; i < 6; ++i) {  // proper pairs
    clean[(2 * i + 1) * 100 + 2] = clean[2 * i * 100 + 2];
    clean[(2 * i + 1) * 100 + 3] = clean[2 * i * 100 + 3];
  }
  for (std::size_t block = 0; block < 12; ++block) {
    for (std::size_t slot = 0; slot < 32; ++slot) put_return(clean, block, slot, 3000);
  }
  DecodedPacket packet;
  const velodyne::VelodyneDecoder decoder(*velodyne::find_model("velodyne_vlp16"), {});
  for (int run = 0; run < 20'000; ++run) {
    auto bytes = clean;
    const int flips = std::uniform_int_distribution<int>(1, 6)(random);
    for (int i = 0; i < flips; ++i) {
      bytes[std::uniform_int_distribution<std::size_t>(0, 1205)(random)] ^=
          static_cast<std::uint8_t>(1U << std::uniform_int_distribution<int>(0, 7)(random));
    }
    if (!decoder.decode(bytes, packet).ok()) {
      EXPECT_TRUE(packet.points.empty());
      continue;
    }
    EXPECT_LE(packet.points.size(), 384U);
    EXPECT_LE(packet.duration, std::chrono::milliseconds(310));
    for (const LidarPoint& point : packet.points) {
      EXPECT_LE(point.dt_ns, 0);
      EXPECT_GE(point.dt_ns, -packet.duration.count());
      EXPECT_LE(std::hypot(point.x, point.y, point.z), 131.1F);
    }
  }
}

}  // namespace
}  // namespace hulltrack
