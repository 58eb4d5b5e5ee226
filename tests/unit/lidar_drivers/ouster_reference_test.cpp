// The decoder against a cloud that the maker's own library made of the same real datagrams of an OS-1-128.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/ouster/ouster_decoder.hpp"
#include "lidar_drivers/packet_sequence.hpp"
#include "lidar_drivers/pcap_source.hpp"
#include "tests/support/ouster_reference.hpp"

namespace hulltrack {
namespace {

class OusterReference : public testing::Test {
 protected:
  void SetUp() override {
    const auto folder = test::ouster_reference_folder();
    const auto metadata = ouster::read_metadata(folder / "metadata.json");
    auto source = PcapSource::open(folder / "packets.pcap");
    if (!metadata || !source) GTEST_SKIP() << "no reference capture in " << folder;
    decoder_ = std::make_unique<ouster::OusterDecoder>(*metadata, DecoderOptions{});
    Datagram datagram;
    for (;;) {
      const auto more = source->next(datagram);
      ASSERT_TRUE(more.ok());
      if (!*more) break;
      all_.emplace_back(datagram.bytes.begin(), datagram.bytes.end());
      ports_.push_back(datagram.destination_port);
    }
  }

  std::unique_ptr<ouster::OusterDecoder> decoder_;
  std::vector<std::vector<std::uint8_t>> all_;
  std::vector<std::uint16_t> ports_;
};

TEST_F(OusterReference, EveryPointOfTheMakersLiesWithinAMillimetre) {
  const auto reference = test::read_ouster_reference();
  ASSERT_EQ(reference.size(), 107'357U);
  constexpr std::uint16_t kFrame = 1796;
  DecodedPacket packet;
  std::size_t next = 0;
  double worst = 0.0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (ports_[i] != 7502 || read_le16(all_[i], 2) != kFrame) continue;
    ASSERT_TRUE(decoder_->decode(all_[i], packet).ok());
    ASSERT_LE(next + packet.points.size(), reference.size());
    for (const LidarPoint& point : packet.points) {
      const test::OusterReferencePoint& truth = reference[next++];
      worst = std::max(worst, std::hypot(point.x - truth.x, point.y - truth.y, point.z - truth.z));
      ASSERT_EQ(int{point.channel}, truth.row);
      ASSERT_EQ(int{point.intensity}, truth.reflectivity);
      ASSERT_EQ(packet.sensor_time.count() + point.dt_ns, truth.timestamp_ns);
    }
  }
  EXPECT_EQ(next, reference.size());
  EXPECT_LE(worst, 1e-3);
  RecordProperty("worst_mm", std::to_string(worst * 1e3));
  std::printf("worst of %zu points: %.5f mm\n", next, worst * 1e3);
}

TEST_F(OusterReference, FramesHaveTheMakersCountsAndNothingIsMissed) {
  PacketSequence sequence(decoder_->clock_wrap());
  DecodedPacket packet;
  std::map<std::uint16_t, std::size_t> points;
  int turns = 0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (ports_[i] != 7502) {
      EXPECT_EQ(decoder_->decode(all_[i], packet).status, DecodeStatus::wrong_size);  // the IMU's
      continue;
    }
    ASSERT_TRUE(decoder_->decode(all_[i], packet).ok());
    points[read_le16(all_[i], 2)] += packet.points.size();
    if (packet.zero_crossing) ++turns;
    EXPECT_NEAR(packet.rotation_rate, 62.83, 0.7);
    EXPECT_NEAR(to_seconds(packet.interval), 1.5625e-3, 2e-5);
    const auto step = sequence.note(all_[i], packet, MeasurementTime(packet.sensor_time));
    EXPECT_EQ(step.lost, 0U);
    EXPECT_NE(step.place, PacketSequence::Place::restart);
  }
  EXPECT_EQ(points,
            (std::map<std::uint16_t, std::size_t>{{1795, 107'647}, {1796, 107'357}, {1797, 107'532}}));
  EXPECT_EQ(turns, 3);
}

TEST_F(OusterReference, DamagedDatagramsAreRefusedOrStayInBounds) {
  std::mt19937 random(11);
  DecodedPacket packet;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    for (std::size_t size = i % 61; size < all_[i].size(); size += 61) {
      ASSERT_FALSE(decoder_->decode(Bytes(all_[i]).first(size), packet).ok());
    }
    for (int run = 0; run < 10; ++run) {
      auto bytes = all_[i];
      for (int flip = 0; flip < 50; ++flip)
        bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
      if (!decoder_->decode(bytes, packet).ok()) continue;
      ASSERT_LE(packet.points.size(), 2048U);
      for (const LidarPoint& point : packet.points) {
        ASSERT_LE(point.dt_ns, 0);
        ASSERT_GE(point.dt_ns, -packet.duration.count());
        ASSERT_LE(std::hypot(point.x, point.y, point.z), 262.2);
      }
    }
  }
}

}  // namespace
}  // namespace hulltrack
