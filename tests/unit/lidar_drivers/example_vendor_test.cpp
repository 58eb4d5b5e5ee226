// A whole vendor in little space: copy this when you add a LiDAR (CONTRIBUTING.md, "A new LiDAR").
//
// The "example_one" sends, little endian: flag 0x5845, microseconds of the hour u32 of the first shot, rotor
// azimuth u16 of the first shot in 0.01 deg, and 24 shots 50 us apart of {range u16 in cm, intensity u8}; it
// turns at 600 rpm and has one laser in the horizon. A real vendor's folder holds the three parts below as
// example_format.hpp, example_decoder.{hpp,cpp} and example_models.{hpp,cpp}.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/text.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/frame_assembler.hpp"
#include "lidar_drivers/lidar_model.hpp"
#include "lidar_drivers/packet_sequence.hpp"

namespace hulltrack {
namespace example {

// 1. The format: facts with their source, no code.
constexpr std::size_t kShots = 24;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kShotBytes = 3;
constexpr std::size_t kPacketBytes = kHeaderBytes + kShots * kShotBytes;
constexpr std::uint16_t kFlag = 0x5845;
constexpr Nanoseconds kShotPeriod = std::chrono::microseconds(50);
constexpr double kRate = 20.0 * std::numbers::pi;  // rad/s

// 2. The decoder: checks every byte that it uses, keeps nothing, allocates nothing once `out` has grown.
class ExampleDecoder final : public Decoder {
 public:
  explicit ExampleDecoder(const DecoderOptions& options) : options_(options) {}

  [[nodiscard]] DecodeOutcome decode(std::span<const std::uint8_t> payload,
                                     DecodedPacket& out) const override {
    out.points.clear();
    out.zero_crossing.reset();
    out.cut_azimuth.reset();
    out.counter.reset();
    if (payload.size() != kPacketBytes)
      return {DecodeStatus::wrong_size, kPacketBytes, static_cast<std::uint32_t>(payload.size())};
    if (const std::uint16_t flag = read_le16(payload, 0); flag != kFlag)
      return {DecodeStatus::bad_flag, kFlag, flag};
    const std::uint16_t azimuth = read_le16(payload, 6);
    if (azimuth >= 36000) return {DecodeStatus::bad_azimuth, 0, azimuth};

    // Times hang on the LAST shot: the datagram is received when that has been fired.
    out.duration = (kShots - 1) * kShotPeriod;
    out.interval = kShots * kShotPeriod;
    out.sensor_time = (std::chrono::microseconds(read_le32(payload, 2)) + out.duration) % clock_wrap();
    out.rotation_rate = kRate;
    out.first_azimuth = azimuth * std::numbers::pi / 18000.0;
    out.last_azimuth =
        std::fmod(out.first_azimuth + kRate * to_seconds(out.duration), 2.0 * std::numbers::pi);
    if (out.last_azimuth < out.first_azimuth)
      out.zero_crossing = Nanoseconds(-std::llround(1e9 * out.last_azimuth / kRate));
    out.return_mode = ReturnMode::strongest;
    out.clock_reference = ClockReference::unknown;  // its datagrams do not say whether it is synchronised
    for (std::size_t shot = 0; shot < kShots; ++shot) {
      const std::size_t at = kHeaderBytes + shot * kShotBytes;
      const double range = 0.01 * read_le16(payload, at);
      if (range == 0.0) continue;  // nothing came back: no point
      const Nanoseconds since_first = static_cast<int>(shot) * kShotPeriod;
      const double turned = options_.firing_correction ? kRate * to_seconds(since_first) : 0.0;
      // L: x forward at azimuth 0, y left; azimuth counts clockwise seen from above.
      out.points.push_back({.x = static_cast<float>(range * std::cos(out.first_azimuth + turned)),
                            .y = static_cast<float>(-range * std::sin(out.first_azimuth + turned)),
                            .z = 0.0F,
                            .dt_ns = static_cast<std::int32_t>((since_first - out.duration).count()),
                            .intensity = payload[at + 2],
                            .channel = 0,
                            .echo = 0});
    }
    return {};
  }

  /// What was expected and what was seen, for a person who compares sensor and configuration.
  [[nodiscard]] std::string explain(const DecodeOutcome& outcome) const override {
    switch (outcome.status) {
      case DecodeStatus::wrong_size:
        return format_text("expected datagrams of %u bytes, saw %u bytes", outcome.expected, outcome.seen);
      case DecodeStatus::bad_flag:
        return format_text("expected flag 0x%04X, saw 0x%04X", outcome.expected, outcome.seen);
      case DecodeStatus::bad_azimuth:
        return format_text("expected an azimuth below 360 deg, saw %.2f deg", 0.01 * outcome.seen);
      default:
        return "ok";
    }
  }

  [[nodiscard]] Nanoseconds clock_wrap() const override { return std::chrono::hours(1); }

 private:
  DecoderOptions options_;
};

// 3. The rows of the registry; model_registry.cpp takes them in with one line: add(example::lidar_models()).
std::vector<LidarModel> lidar_models() {
  return {{.name = "example_one",
           .vendor = "Example",
           .title = "One",
           .port = 4711,
           .range = 50.0,
           .channels = 1,
           .make_decoder = [](const DecoderOptions& options,
                              const std::filesystem::path&) -> Result<std::unique_ptr<Decoder>> {
             return std::unique_ptr<Decoder>(std::make_unique<ExampleDecoder>(options));
           }}};
}

}  // namespace example

namespace {

std::vector<std::uint8_t> datagram(std::uint32_t number) {
  std::vector<std::uint8_t> bytes(example::kPacketBytes);
  write_le16(bytes, 0, example::kFlag);
  write_le32(bytes, 2, number * 1200);
  write_le16(bytes, 6, static_cast<std::uint16_t>(number * 432 % 36000));
  for (std::size_t shot = 0; shot < example::kShots; ++shot) {
    write_le16(bytes, example::kHeaderBytes + shot * example::kShotBytes, 1000);
  }
  return bytes;
}

TEST(ExampleVendor, ItsPointsLieOnTheCircleThatItSees) {
  const LidarModel model = example::lidar_models().front();
  const auto decoder = model.make_decoder({}, {});
  ASSERT_TRUE(decoder.ok());
  DecodedPacket packet;
  ASSERT_TRUE((*decoder)->decode(datagram(3), packet).ok());
  ASSERT_EQ(packet.points.size(), example::kShots);
  EXPECT_EQ(packet.points.back().dt_ns, 0) << "the last shot is the datagram's time";
  for (const LidarPoint& point : packet.points) EXPECT_NEAR(std::hypot(point.x, point.y), 10.0F, 1e-4F);
  EXPECT_NEAR(std::atan2(-packet.points.back().y, packet.points.back().x), packet.last_azimuth, 1e-6);
}

TEST(ExampleVendor, ALossIsToldByTheTimesThatTheDecoderGives) {
  const example::ExampleDecoder decoder({});
  PacketSequence sequence(decoder.clock_wrap());
  DecodedPacket packet;
  std::uint32_t lost = 0;
  for (const std::uint32_t number : {0U, 1U, 4U, 5U}) {
    const auto bytes = datagram(number);
    ASSERT_TRUE(decoder.decode(bytes, packet).ok());
    lost += sequence.note(bytes, packet, MeasurementTime{number * packet.interval}).lost;
  }
  EXPECT_EQ(lost, 2U);
}

TEST(ExampleVendor, WhatIsNotItsOwnIsRefusedInWords) {
  const example::ExampleDecoder decoder({});
  DecodedPacket packet;
  const auto words = [&](const std::vector<std::uint8_t>& bytes) {
    return decoder.explain(decoder.decode(bytes, packet));
  };
  EXPECT_EQ(words(std::vector<std::uint8_t>(79)), "expected datagrams of 80 bytes, saw 79 bytes");
  EXPECT_EQ(words(std::vector<std::uint8_t>(80)), "expected flag 0x5845, saw 0x0000");
}

}  // namespace
}  // namespace hulltrack
