// The little that there is of a real Mid-360: one datagram, whole only with zeros in place of what was cut
// off.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/livox/livox_decoder.hpp"
#include "lidar_drivers/pcap_source.hpp"

namespace hulltrack {
namespace {

std::filesystem::path folder() {
  return std::filesystem::path(HULLTRACK_SHARED_DIR) / "lidar" / "livox_mid360";
}

/// The first datagram of a capture; empty when there is none.
std::vector<std::uint8_t> first_datagram(const char* file) {
  auto source = PcapSource::open(folder() / file);
  Datagram datagram;
  if (!source) return {};
  const auto more = source->next(datagram);
  if (!more || !*more) return {};
  return {datagram.bytes.begin(), datagram.bytes.end()};
}

TEST(LivoxReference, TheOneStatedPointComesOut) {
  if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no reference capture in " << folder();
  const auto bytes = first_datagram("packets_zero_padded.pcap");
  const livox::LivoxDecoder decoder(*livox::find_model("livox_mid360"), {});
  DecodedPacket packet;
  ASSERT_TRUE(decoder.decode(bytes, packet).ok());
  ASSERT_EQ(packet.points.size(), 1U);
  const LidarPoint& point = packet.points[0];
  EXPECT_FLOAT_EQ(point.x, -1.019F);
  EXPECT_FLOAT_EQ(point.y, -1.705F);
  EXPECT_FLOAT_EQ(point.z, 2.494F);
  EXPECT_EQ(point.intensity, 4);
  EXPECT_EQ(point.channel, 3);
}

TEST(LivoxReference, TheTruncatedDatagramIsRefused) {
  if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no reference capture in " << folder();
  const auto whole = first_datagram("packets_zero_padded.pcap");
  ASSERT_EQ(whole.size(), 1380U);
  const livox::LivoxDecoder decoder(*livox::find_model("livox_mid360"), {});
  DecodedPacket packet;
  // The source of captures drops the record, or hands out what there is of it: neither gives a point.
  const auto truncated = first_datagram("packets.pcap");
  EXPECT_FALSE(decoder.decode(truncated, packet).ok());
  EXPECT_FALSE(decoder.decode(Bytes(whole).first(92), packet).ok());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_FALSE(decoder.decode(Bytes(whole).first(size), packet).ok());
    ASSERT_TRUE(packet.points.empty());
  }
  std::mt19937 random(2);
  for (int run = 0; run < 2'000; ++run) {
    auto bytes = whole;
    for (int i = 0; i < 20; ++i)
      bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    static_cast<void>(decoder.decode(bytes, packet));
    ASSERT_LE(packet.points.size(), 96U);
  }
}

}  // namespace
}  // namespace hulltrack
