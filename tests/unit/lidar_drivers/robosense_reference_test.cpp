// The Helios 32 decoder against the cloud that the maker's own driver made of the same real packets, and the
// same packets damaged.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>

#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/pcap_source.hpp"
#include "lidar_drivers/robosense/robosense_decoder.hpp"
#include "tests/support/reference_table.hpp"

namespace hulltrack {
namespace {

using Packets = std::vector<std::vector<std::uint8_t>>;
using Slot = std::array<int, 3>;  // packet, block, channel

struct Decoded {
  LidarPoint point;
  Nanoseconds sensor_time;
};

std::filesystem::path folder() { return test::capture_folder("robosense_helios32"); }

/// Datagrams of the capture in order; empty where it is absent.
Packets capture() {
  Packets packets;
  if (!std::filesystem::exists(folder() / "packets.pcap")) return packets;
  auto source = PcapSource::open(folder() / "packets.pcap");
  EXPECT_TRUE(source.ok());
  Datagram datagram;
  while (source.ok()) {
    const auto more = source->next(datagram);
    EXPECT_TRUE(more.ok());
    if (!more || !*more) break;
    packets.emplace_back(datagram.bytes.begin(), datagram.bytes.end());
  }
  return packets;
}

std::unique_ptr<Decoder> helios32() {
  auto made = make_lidar_decoder(*find_lidar_model("robosense_helios32"), {}, folder() / "difop.bin");
  EXPECT_TRUE(made.ok());
  return std::move(made).value();
}

/// Points by where they stand in the capture, without those that the maker's driver filters away, and how
/// many lie in each revolution: one begins where a block's azimuth is smaller than the one before.
struct Cloud {
  std::map<Slot, Decoded> points;
  std::map<int, int> in_frame;
};

Cloud decode_capture(const Packets& packets) {
  constexpr int kNearest = 40;  // x 0.0025 m: its driver drops up to and including 0.1 m
  Cloud cloud;
  const auto decoder = helios32();
  DecodedPacket packet;
  int frame = 0;
  int last_azimuth = 0;
  for (std::size_t index = 0; index < packets.size(); ++index) {
    const auto& bytes = packets[index];
    if (decoder->inform(bytes)) continue;
    EXPECT_EQ(decoder->decode(bytes, packet).status, DecodeStatus::ok);
    EXPECT_EQ(packet.return_mode, ReturnMode::strongest);
    EXPECT_FALSE(packet.cut_azimuth);
    auto point = packet.points.begin();
    for (int block = 0; block < 12; ++block) {
      const std::size_t at = 42 + static_cast<std::size_t>(block) * 100;
      const int azimuth = bytes[at + 2] << 8 | bytes[at + 3];
      if (azimuth < last_azimuth) ++frame;
      last_azimuth = azimuth;
      for (int channel = 0; channel < 32; ++channel) {
        const std::size_t slot = at + 4 + static_cast<std::size_t>(channel) * 3;
        const int raw = bytes[slot] << 8 | bytes[slot + 1];
        if (raw == 0) continue;
        if (point == packet.points.end()) return cloud;
        if (raw > kNearest) {
          cloud.points[{static_cast<int>(index), block, channel}] = {
              *point, packet.sensor_time + Nanoseconds(point->dt_ns)};
          ++cloud.in_frame[frame];
        }
        ++point;
      }
    }
    EXPECT_EQ(point, packet.points.end());
  }
  return cloud;
}

TEST(RobosenseReference, EveryPointIsTheMakersDriversWithinAMillimetre) {
  // frame, x, y, z, intensity, ring, time s, packet, block, channel
  const auto truth = test::read_reference_table<10>(folder() / "truth.csv.gz");
  if (truth.empty()) GTEST_SKIP() << "no reference capture in " << folder();
  const Cloud cloud = decode_capture(capture());
  EXPECT_EQ(cloud.in_frame.at(1), 28694);
  EXPECT_EQ(cloud.in_frame.at(4), 28801);

  std::map<int, int> in_frame;
  double worst = 0.0;
  double worst_time = 0.0;
  for (const auto& row : truth) {
    ++in_frame[static_cast<int>(row[0])];
    const auto it =
        cloud.points.find({static_cast<int>(row[7]), static_cast<int>(row[8]), static_cast<int>(row[9])});
    ASSERT_NE(it, cloud.points.end()) << "packet " << row[7] << " block " << row[8] << " channel " << row[9];
    const LidarPoint& point = it->second.point;
    EXPECT_EQ(point.intensity, static_cast<int>(row[4]));
    EXPECT_EQ(point.channel, static_cast<int>(row[9]));
    worst = std::max(worst, std::hypot(point.x - row[1], point.y - row[2], point.z - row[3]));
    worst_time = std::max(worst_time, std::abs(to_seconds(it->second.sensor_time) - row[6]));
  }
  EXPECT_EQ(in_frame, (std::map<int, int>{{1, 28694}, {4, 28801}}));
  EXPECT_LE(worst, 0.001);
  EXPECT_LE(worst_time, 1e-6);  // the reference is written to a microsecond
  std::printf("worst of %zu points: %.4f mm, %.2f us\n", truth.size(), worst * 1e3, worst_time * 1e6);
}

TEST(RobosenseReference, TheCaptureNamesItsUnitToASixteenLaserModel) {
  const auto packets = capture();
  if (packets.empty()) GTEST_SKIP() << "no reference capture in " << folder();
  robosense::RobosenseDecoder decoder(*robosense::find_model("robosense_helios16p"), {});
  DecodedPacket packet;
  EXPECT_EQ(decoder.decode(packets[0], packet).status, DecodeStatus::awaiting_angles);
  for (const auto& bytes : packets) static_cast<void>(decoder.inform(bytes));
  EXPECT_EQ(decoder.explain(decoder.decode(packets[0], packet)),
            "expected a unit of 16 lasers; this is a unit of 32 lasers: model = robosense_helios32?");
}

TEST(RobosenseReference, TheUnitCountsItsDatagrams) {
  const auto packets = capture();
  if (packets.empty()) GTEST_SKIP() << "no reference capture in " << folder();
  const auto decoder = helios32();
  DecodedPacket packet;
  std::optional<std::uint64_t> before;
  std::size_t steps = 0;
  for (const auto& bytes : packets) {
    if (decoder->inform(bytes)) continue;
    ASSERT_TRUE(decoder->decode(bytes, packet).ok());
    ASSERT_TRUE(packet.counter);
    if (before) {
      EXPECT_EQ(packet.counter->value, *before + 1);
      ++steps;
    }
    before = packet.counter->value;
  }
  EXPECT_EQ(steps, 749U);
  EXPECT_EQ(packet.clock_reference, ClockReference::none) << "its clock shows 2017";
}

TEST(RobosenseReference, CutPacketsAreRefused) {
  const auto packets = capture();
  if (packets.empty()) GTEST_SKIP() << "no reference capture in " << folder();
  const auto decoder = helios32();
  DecodedPacket packet;
  for (const auto& bytes : packets) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      // A copy of its own: reading past the end is an error that the sanitizer sees.
      if (size % 97 == 0) {
        const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        ASSERT_EQ(decoder->decode(cut, packet).status, DecodeStatus::wrong_size);
      }
      const auto cut = std::span(bytes).first(size);
      ASSERT_EQ(decoder->decode(cut, packet).status, DecodeStatus::wrong_size);
      ASSERT_FALSE(decoder->inform(cut));
    }
  }
}

TEST(RobosenseReference, FlippedBitsNeverLeadOutOfBounds) {
  const auto packets = capture();
  if (packets.empty()) GTEST_SKIP() << "no reference capture in " << folder();
  constexpr double kFarthest = 65535 * 0.0025 + 0.03498 + 1e-3;  // m
  std::mt19937 random(7);
  const auto decoder = helios32();
  DecodedPacket packet;
  std::size_t decoded = 0;
  for (const auto& clean : packets) {
    for (int run = 0; run < 20; ++run) {
      auto bytes = clean;
      const int flips = std::uniform_int_distribution<int>(1, 6)(random);
      for (int i = 0; i < flips; ++i) {
        bytes[std::uniform_int_distribution<std::size_t>(0, 1247)(random)] ^=
            static_cast<std::uint8_t>(1U << std::uniform_int_distribution<int>(0, 7)(random));
      }
      if (decoder->inform(bytes)) {
        for (int again = 0; again < 2; ++again) ASSERT_TRUE(decoder->inform(clean));
        continue;
      }
      if (!decoder->decode(bytes, packet).ok()) {
        ASSERT_TRUE(packet.points.empty());
        continue;
      }
      ++decoded;
      ASSERT_LE(packet.points.size(), 384U);
      ASSERT_LE(packet.duration, std::chrono::milliseconds(310));
      for (const LidarPoint& point : packet.points) {
        ASSERT_LE(point.dt_ns, 0);
        ASSERT_GE(point.dt_ns, -packet.duration.count());
        ASSERT_LE(std::hypot(point.x, point.y, point.z), kFarthest);
      }
    }
  }
  EXPECT_GT(decoded, 10'000U);
}

}  // namespace
}  // namespace hulltrack
