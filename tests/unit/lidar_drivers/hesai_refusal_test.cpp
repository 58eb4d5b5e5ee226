// What the decoder refuses and how it is said; sizes, what flags announce, damaged bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/hesai_decode.hpp"

namespace hulltrack {
namespace {

using test::decode;
using test::hesai_azimuths;
using test::hesai_bytes;
using test::hesai_model;
using test::HesaiBytes;
using test::HesaiModel;
using test::put_return;
using test::refusal;

const HesaiModel& kXt32 = hesai_model("hesai_xt32");

TEST(HesaiRefusal, RefusalsNameWhatWasExpectedAndSeen) {
  const auto good = hesai_bytes(kXt32, hesai_azimuths(kXt32, 0, 18));
  EXPECT_EQ(refusal(kXt32, good), "ok");
  const auto with = [&](std::size_t at, std::uint8_t value) {
    auto bytes = good;
    bytes[at] = value;
    return refusal(kXt32, bytes);
  };
  EXPECT_EQ(with(0, 0xAB), "expected flag 0xFFEE, saw 0xFFAB");
  EXPECT_EQ(with(2, 3),
            "expected protocol 6, 32 lasers, 8 blocks, 4 mm, saw protocol 3, 32 lasers, 8 blocks, 4 mm");
  EXPECT_EQ(with(9, 40),
            "expected protocol 6, 32 lasers, 8 blocks, 6 mm, saw protocol 6, 32 lasers, 8 blocks, 40 mm");
  EXPECT_EQ(with(9, 5), "ok");
  EXPECT_EQ(with(11, 0), "expected datagrams of 1076 bytes, saw 1080 bytes");
  EXPECT_EQ(with(11, 9), "expected datagrams of 1112 bytes, saw 1080 bytes");
  EXPECT_EQ(with(kXt32.mode, 0x3D), "expected return mode 0x33, 0x37, 0x38, 0x39, 0x3B or 0x3C, saw 0x3D");
  EXPECT_EQ(with(13, 0x8D), "expected the azimuths of a turning sensor, saw 360.96 deg");
  EXPECT_EQ(refusal(kXt32, hesai_bytes(hesai_model("hesai_xt16"), {})),
            "expected protocol 6, 32 lasers, 8 blocks, 4 mm, saw protocol 6, 16 lasers, 8 blocks, 4 mm");
  EXPECT_EQ(refusal(kXt32, hesai_bytes(kXt32, hesai_azimuths(kXt32, 0, 100))),
            "expected the azimuths of a turning sensor, saw 1.00 deg");  // 3333 rpm
  const HesaiModel& headless = hesai_model("hesai_pandar40p");
  auto bytes = hesai_bytes(headless, hesai_azimuths(headless, 0, 20));
  bytes[124] = 0;
  EXPECT_EQ(refusal(headless, bytes), "expected flag 0xEEFF, saw 0xEE00");
}

TEST(HesaiRefusal, AnnouncedAppendicesAreCountedIn) {
  for (const HesaiModel& model : test::kHesaiModels) {
    SCOPED_TRACE(model.name);
    auto bytes = hesai_bytes(model, hesai_azimuths(model, 0, 18));
    bytes.resize(model.sequence);
    if (model.header == 12) bytes[11] = 0;
    EXPECT_FALSE(decode(model, bytes).counter);
  }
  auto signed_one = hesai_bytes(kXt32, hesai_azimuths(kXt32, 0, 18));
  signed_one[11] = 9;
  signed_one.resize(1112);
  EXPECT_EQ(decode(kXt32, signed_one).counter->value, 77U);
}

TEST(HesaiRefusal, EverySizeIsRefusedButTheRightOnes) {
  for (const HesaiModel& model : test::kHesaiModels) {
    const auto good = hesai_bytes(model, hesai_azimuths(model, 0, 18));
    const auto decoder = test::hesai_decoder(model);
    DecodedPacket packet;
    for (std::size_t size = 0; size <= 1400; ++size) {
      HesaiBytes bytes(size, 0xFF);
      std::copy_n(good.begin(), std::min(size, good.size()), bytes.begin());
      const bool right = size == model.size || (model.header < 12 && size == model.size - 4);
      EXPECT_EQ(decoder->decode(bytes, packet).ok(), right) << model.name << ' ' << size;
    }
  }
}

TEST(HesaiRefusal, FlippedBitsNeverLeadOutOfBounds) {
  std::mt19937 random(7);
  for (const HesaiModel& model : test::kHesaiModels) {
    auto clean = hesai_bytes(model, hesai_azimuths(model, 35960, 18, 2), 0x39);
    for (std::size_t block = 0; block < static_cast<std::size_t>(model.blocks); ++block) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(model.lasers); ++k)
        put_return(clean, model, block, k, static_cast<int>(3000 + block));
    }
    DecodedPacket packet;
    const auto decoder = test::hesai_decoder(model);
    for (int run = 0; run < 5'000; ++run) {
      auto bytes = clean;
      const int flips = std::uniform_int_distribution<int>(1, 6)(random);
      for (int i = 0; i < flips; ++i) {
        bytes[std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random)] ^=
            static_cast<std::uint8_t>(1U << std::uniform_int_distribution<int>(0, 7)(random));
      }
      if (!decoder->decode(bytes, packet).ok()) {
        EXPECT_TRUE(packet.points.empty());
        continue;
      }
      EXPECT_LE(packet.points.size(), static_cast<std::size_t>(model.blocks * model.lasers));
      EXPECT_LE(packet.duration, std::chrono::milliseconds(310));
      for (const LidarPoint& point : packet.points) {
        EXPECT_LE(point.dt_ns, 0);
        EXPECT_GE(point.dt_ns, -packet.duration.count());
        EXPECT_LE(std::hypot(point.x, point.y, point.z), 65535 * 0.006F + 0.1F);
      }
    }
  }
}

}  // namespace
}  // namespace hulltrack
