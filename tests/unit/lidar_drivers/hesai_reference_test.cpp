// The PandarXT-32 decoder against a cloud that an independent decoder made of the same real datagrams.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "core/geometry/se3.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/hesai/hesai_angles.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/pcap_source.hpp"
#include "tests/support/reference_table.hpp"

namespace hulltrack {
namespace {

using Place = std::tuple<int, int, int>;  // datagram, block, channel

constexpr int kFirst = 1498;  // datagrams of the turn that the reference covers
constexpr int kLast = 1998;

std::filesystem::path folder() { return test::capture_folder("hesai_xt32"); }

std::vector<std::vector<std::uint8_t>> read_capture() {
  std::vector<std::vector<std::uint8_t>> datagrams;
  auto source = PcapSource::open(folder() / "packets.pcap");
  if (!source) return datagrams;
  Datagram datagram;
  for (auto more = source->next(datagram); more && *more; more = source->next(datagram))
    datagrams.emplace_back(datagram.bytes.begin(), datagram.bytes.end());
  return datagrams;
}

std::unique_ptr<Decoder> make_decoder(const DecoderOptions& options) {
  auto decoder = make_lidar_decoder(*find_lidar_model("hesai_xt32"), options, folder() / "PandarXT32.csv");
  EXPECT_TRUE(decoder.ok());
  return decoder.ok() ? std::move(decoder).value() : nullptr;
}

std::size_t return_at(int block, int channel) {
  return static_cast<std::size_t>(14 + block * 130 + channel * 4);
}

int raw_at(const std::vector<std::uint8_t>& bytes, int block, int channel) {
  return read_le16(bytes, return_at(block, channel));
}

/// What the reference decoder leaves out: returns beyond 0.05 to 120 m, and the first of a pair that agrees
/// in distance and reflectivity or lies within 0.1 m of the second.
bool reference_keeps(const std::vector<std::uint8_t>& bytes, int block, int channel) {
  const int raw = raw_at(bytes, block, channel);
  if (raw * 4 < 50 || raw * 4 > 120'000) return false;
  const int other = block ^ 1;
  const float between =
      std::abs(static_cast<float>(raw * 0.004) - static_cast<float>(raw_at(bytes, other, channel) * 0.004));
  return block % 2 == 1 || between >= 0.1F;
}

/// Whether the reference's turn holds it: from the laser's own passage through zero to the next.
bool in_turn(int datagram, double azimuth_deg) {
  if (datagram < kFirst + 100) return azimuth_deg > 0.0 && azimuth_deg < 180.0;
  if (datagram > kLast - 100) return azimuth_deg > 180.0 || azimuth_deg == 0.0;
  return true;
}

class HesaiReference : public testing::Test {
 protected:
  void SetUp() override {
    datagrams_ = read_capture();
    if (datagrams_.empty()) GTEST_SKIP() << "no reference capture in " << folder();
  }
  std::vector<std::vector<std::uint8_t>> datagrams_;
};

TEST_F(HesaiReference, EveryPointOfTheTurnLiesWithinAMillimetre) {
  const auto rows = test::read_reference_table<7>(folder() / "truth.csv.gz");
  ASSERT_EQ(rows.size(), 63'021U);
  std::map<Place, const std::array<double, 7>*> reference;
  for (const auto& row : rows)
    reference[{static_cast<int>(row[5]), static_cast<int>(row[6]), static_cast<int>(row[4])}] = &row;
  const auto angles = hesai::load_angles(folder() / "PandarXT32.csv", *hesai::find_model("hesai_xt32"));
  ASSERT_TRUE(angles.ok());
  const auto decoder = make_decoder({.firing_correction = false, .repeated_echoes = true});
  ASSERT_TRUE(decoder);

  DecodedPacket packet;
  std::size_t matched = 0;
  double worst = 0.0;
  for (int index = kFirst; index <= kLast; ++index) {
    const auto& bytes = datagrams_.at(static_cast<std::size_t>(index));
    ASSERT_TRUE(decoder->decode(bytes, packet).ok());
    EXPECT_EQ(packet.return_mode, ReturnMode::dual);
    auto point = packet.points.begin();
    for (int block = 0; block < 8; ++block) {
      const double block_azimuth = read_le16(bytes, static_cast<std::size_t>(12 + block * 130)) * 0.01;
      for (int channel = 0; channel < 32; ++channel) {
        if (raw_at(bytes, block, channel) == 0) continue;
        ASSERT_NE(point, packet.points.end());
        const LidarPoint& seen = *point++;
        EXPECT_EQ(seen.channel, channel);
        const double azimuth = std::fmod(
            block_azimuth + (*angles)[static_cast<std::size_t>(channel)].azimuth_deg + 360.0, 360.0);
        if (!reference_keeps(bytes, block, channel) || !in_turn(index, azimuth)) continue;
        const auto it = reference.find({index, block, channel});
        ASSERT_NE(it, reference.end())
            << "datagram " << index << " block " << block << " channel " << channel;
        const auto& truth = *it->second;
        EXPECT_EQ(seen.intensity, truth[3]);
        ++matched;  // L is (y, -x, z) of the manual's axes
        worst = std::max(worst, std::hypot(seen.x - truth[1], seen.y + truth[0], seen.z - truth[2]));
      }
    }
    EXPECT_EQ(point, packet.points.end());
  }
  EXPECT_EQ(matched, rows.size());
  EXPECT_LE(worst, 0.001);
  RecordProperty("worst_mm", std::to_string(worst * 1e3));
  std::printf("worst of %zu points: %.4f mm\n", matched, worst * 1e3);
}

TEST_F(HesaiReference, InServiceEachFiringHasOneLastReturnAndNoneTwice) {
  const auto service = make_decoder({});
  const auto whole = make_decoder({.repeated_echoes = true});
  ASSERT_TRUE(service && whole);
  DecodedPacket packet;
  DecodedPacket all;
  std::size_t further = 0;
  std::size_t dropped = 0;
  for (const auto& bytes : datagrams_) {
    ASSERT_TRUE(service->decode(bytes, packet).ok());
    ASSERT_TRUE(whole->decode(bytes, all).ok());
    dropped += all.points.size() - packet.points.size();
    std::map<std::pair<int, int>, int> last_returns;
    for (const LidarPoint& point : packet.points) {
      further += point.echo;
      last_returns[{point.dt_ns, point.channel}] += point.echo == 0 ? 1 : 0;
    }
    for (const auto& [firing, count] : last_returns) ASSERT_EQ(count, 1);
  }
  std::size_t pairs_apart = 0;
  std::size_t pairs_alike = 0;
  for (const auto& bytes : datagrams_) {
    for (int block = 0; block < 8; block += 2) {
      for (int channel = 0; channel < 32; ++channel) {
        const int a = raw_at(bytes, block, channel);
        const int b = raw_at(bytes, block + 1, channel);
        pairs_apart += a != 0 && b != 0 && a != b ? 1U : 0U;
        pairs_alike += a != 0 && a == b ? 1U : 0U;
      }
    }
  }
  EXPECT_EQ(further, pairs_apart);
  EXPECT_EQ(dropped, pairs_alike);
}

TEST_F(HesaiReference, DatagramsFollowEachOtherInTimeCountAndAzimuth) {
  const auto decoder = make_decoder({});
  ASSERT_TRUE(decoder);
  DecodedPacket packet;
  std::optional<DecodedPacket> before;
  std::size_t crossings = 0;
  for (const auto& bytes : datagrams_) {
    ASSERT_TRUE(decoder->decode(bytes, packet).ok());
    EXPECT_FALSE(packet.cut_azimuth);
    EXPECT_NEAR(packet.rotation_rate, radians(3600.0), radians(3600.0) / 500.0);
    if (before) {
      EXPECT_NEAR(static_cast<double>((packet.sensor_time - before->sensor_time - packet.interval).count()),
                  0.0, 1000.0);
      EXPECT_EQ(packet.counter->value, before->counter->value + 1);
      const bool between = packet.first_azimuth < before->last_azimuth;
      crossings += packet.zero_crossing || between ? 1U : 0U;
    }
    before = packet;
  }
  EXPECT_EQ(crossings, 4U);
}

TEST_F(HesaiReference, CutOrDamagedDatagramsNeverLeadOutOfBounds) {
  const auto decoder = make_decoder({});
  ASSERT_TRUE(decoder);
  DecodedPacket packet;
  std::mt19937 random(11);
  for (const auto& bytes : datagrams_) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      ASSERT_FALSE(decoder->decode(std::span(bytes).first(size), packet).ok());
      ASSERT_TRUE(packet.points.empty());
    }
    auto damaged = bytes;
    for (int i = 0; i < 4; ++i) {
      damaged[std::uniform_int_distribution<std::size_t>(0, damaged.size() - 1)(random)] ^=
          static_cast<std::uint8_t>(1U << std::uniform_int_distribution<int>(0, 7)(random));
    }
    if (!decoder->decode(damaged, packet).ok()) continue;
    for (const LidarPoint& point : packet.points) {
      ASSERT_LE(std::hypot(point.x, point.y, point.z), 65535 * 0.006F + 0.1F);
      ASSERT_LE(point.dt_ns, 0);
    }
  }
}

}  // namespace
}  // namespace hulltrack
