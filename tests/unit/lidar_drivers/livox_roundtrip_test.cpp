// Encoder and decoder invert each other, and the pattern is the sensor's: all round, never the same twice.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/livox/livox_decoder.hpp"
#include "lidar_drivers/packet_sequence.hpp"
#include "lidar_drivers/sim/encoder_registry.hpp"

namespace hulltrack {
namespace {

constexpr Nanoseconds kUtc = std::chrono::seconds(1'700'000'000);

std::unique_ptr<const sim::LidarEncoder> mid360() {
  return std::move(sim::make_lidar_encoder("livox_mid360", {.start_azimuth = 2.0, .utc = kUtc})).value();
}

TEST(LivoxRoundTrip, EveryReturnComesBackWhereAndWhenItWasFired) {
  const auto encoder = mid360();
  const livox::LivoxDecoder decoder(*livox::find_model("livox_mid360"), {});
  PacketSequence sequence(decoder.clock_wrap());
  std::mt19937 random(1);
  std::uniform_int_distribution<int> range_mm(100, 70'000);
  std::vector<sim::LaserFiring> firings;
  DecodedPacket packet;
  for (std::uint64_t n = 65'500; n < 65'600; ++n) {  // the count starts again on the way
    encoder->firings(n, firings);
    std::vector<sim::LaserReturn> returns;
    std::vector<std::size_t> hits;
    for (std::size_t i = 0; i < firings.size(); ++i) {
      const bool hit = random() % 5 != 0;
      if (hit) hits.push_back(i);
      returns.push_back({hit ? range_mm(random) * 1e-3 : 0.0, static_cast<std::uint8_t>(random() % 256)});
    }
    const auto bytes = encoder->encode(n, returns);
    ASSERT_EQ(bytes.size(), 1380U);
    ASSERT_TRUE(decoder.decode(bytes, packet).ok());
    EXPECT_EQ(packet.duration, encoder->packet_duration());
    EXPECT_EQ(packet.interval, encoder->packet_interval());
    EXPECT_EQ(packet.sensor_time, kUtc + encoder->last_firing(n));
    const auto step = sequence.note(bytes, packet, MeasurementTime(packet.sensor_time));
    EXPECT_EQ(step.lost, 0U);
    ASSERT_EQ(packet.points.size(), hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const LidarPoint& point = packet.points[i];
      const sim::LaserFiring& firing = firings[hits[i]];
      const Eigen::Vector3d truth = firing.origin + returns[hits[i]].range * firing.direction;
      // Half a millimetre on each axis, and the stored float.
      ASSERT_LE((Eigen::Vector3d(point.x, point.y, point.z) - truth).cwiseAbs().maxCoeff(), 0.0005 + 1e-5);
      EXPECT_EQ(encoder->last_firing(n) + Nanoseconds(point.dt_ns), firing.time);
      EXPECT_EQ(point.channel, firing.channel);
      EXPECT_EQ(point.intensity, returns[hits[i]].intensity);
    }
  }
}

TEST(LivoxEncoder, ATenthOfASecondSeesTheWholeFieldAndTheNextSeesItElsewhere) {
  const auto encoder = mid360();
  std::vector<sim::LaserFiring> firings;
  const auto cells = [&](std::uint64_t from, double degrees_a_cell) {
    std::set<std::pair<int, int>> seen;
    for (std::uint64_t n = from; n < from + 208; ++n) {
      encoder->firings(n, firings);
      for (const sim::LaserFiring& firing : firings) {
        const Eigen::Vector3d& d = firing.direction;
        EXPECT_NEAR(d.norm(), 1.0, 1e-12);
        EXPECT_GE(degrees(std::asin(d.z())), -7.0 - 1e-9);
        EXPECT_LE(degrees(std::asin(d.z())), 52.0 + 1e-9);
        EXPECT_NEAR(d.y(), -std::cos(firing.elevation) * std::sin(firing.azimuth), 1e-12);
        const double around = degrees(std::atan2(d.y(), d.x())) + 180.0;
        seen.insert({static_cast<int>(around / degrees_a_cell),
                     static_cast<int>((degrees(std::asin(d.z())) + 7.0) / degrees_a_cell)});
      }
    }
    return seen;
  };
  EXPECT_GE(cells(0, 10.0).size(), 36U * 6U);  // 59 deg are six cells
  const auto first = cells(0, 0.5);
  const auto second = cells(208, 0.5);
  std::size_t again = 0;
  for (const auto& cell : second) again += first.count(cell);
  EXPECT_LT(static_cast<double>(again), 0.5 * static_cast<double>(second.size()));
}

TEST(LivoxEncoder, RefusesWhatItCannotPlay) {
  EXPECT_FALSE(sim::make_lidar_encoder("livox_avia", {}).ok());
  EXPECT_FALSE(sim::make_lidar_encoder("livox_mid360", {.return_mode = ReturnMode::dual}).ok());
}

}  // namespace
}  // namespace hulltrack
