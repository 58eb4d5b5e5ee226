#include "plc/register_codec.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/register_vectors.hpp"

namespace hulltrack {
namespace {

using test::sample_block;

constexpr std::array kTypes{RegisterType::float32, RegisterType::int32, RegisterType::uint32,
                            RegisterType::int16, RegisterType::uint16};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// 123.456f is 0x42F6E979 in IEEE 754: struct.pack('>f', 123.456).hex() == '42f6e979'.
TEST(RegisterCodec, Float32StandsAsHandWrittenInEveryWordOrder) {
  EXPECT_EQ(encode_float32(123.456F, WordOrder::abcd), (RegisterPair{0x42F6, 0xE979}));
  EXPECT_EQ(encode_float32(123.456F, WordOrder::cdab), (RegisterPair{0xE979, 0x42F6}));
  EXPECT_EQ(encode_float32(123.456F, WordOrder::badc), (RegisterPair{0xF642, 0x79E9}));
  EXPECT_EQ(encode_float32(123.456F, WordOrder::dcba), (RegisterPair{0x79E9, 0xF642}));
  EXPECT_EQ(decode_float32({0x42F6, 0xE979}, WordOrder::abcd), 123.456F);
  EXPECT_EQ(decode_float32({0xE979, 0x42F6}, WordOrder::cdab), 123.456F);
  EXPECT_EQ(decode_float32({0xF642, 0x79E9}, WordOrder::badc), 123.456F);
  EXPECT_EQ(decode_float32({0x79E9, 0xF642}, WordOrder::dcba), 123.456F);
}

// -123456 is 0xFFFE1DC0 in two's complement.
TEST(RegisterCodec, NegativeInt32StandsAsHandWrittenInEveryWordOrder) {
  EXPECT_EQ(encode_int32(-123456, WordOrder::abcd), (RegisterPair{0xFFFE, 0x1DC0}));
  EXPECT_EQ(encode_int32(-123456, WordOrder::cdab), (RegisterPair{0x1DC0, 0xFFFE}));
  EXPECT_EQ(encode_int32(-123456, WordOrder::badc), (RegisterPair{0xFEFF, 0xC01D}));
  EXPECT_EQ(encode_int32(-123456, WordOrder::dcba), (RegisterPair{0xC01D, 0xFEFF}));
  EXPECT_EQ(decode_int32({0xC01D, 0xFEFF}, WordOrder::dcba), -123456);
}

TEST(RegisterCodec, EveryBitPatternSurvivesTheRoundTrip) {
  std::mt19937 random(20240611);
  for (const auto& [order, name] : test::kWordOrders) {
    for (int i = 0; i < 10000; ++i) {
      const auto bits = static_cast<std::uint32_t>(random());
      EXPECT_EQ(decode_uint32(encode_uint32(bits, order), order), bits);
      EXPECT_EQ(std::bit_cast<std::uint32_t>(decode_float32(encode_uint32(bits, order), order)), bits);
    }
  }
}

TEST(ReadBlock, DefaultLayoutIsThatOfTheRegisterTable) {
  const PlcReadConfig config;
  ASSERT_EQ(read_block_size(config), 8);
  // 12.5 m = 0x41480000, -30 deg = 0xC1F00000, 7.25 deg = 0x40E80000.
  const std::array<std::uint16_t, 8> registers{0x4148, 0, 0xC1F0, 0, 0x40E8, 0, 513, 3};
  const PlcReading reading = decode_read_block(registers, config);
  EXPECT_EQ(reading.travel_m, 12.5);
  EXPECT_EQ(reading.slew_deg, -30.0);
  EXPECT_EQ(reading.luff_deg, 7.25);
  EXPECT_EQ(reading.heartbeat, 513);
  EXPECT_EQ(reading.command, 3);
  EXPECT_FALSE(reading.torn);
}

TEST(ReadBlock, SizeReachesToTheLastConfiguredRegister) {
  PlcReadConfig config;
  config.heartbeat_tail = 8;
  EXPECT_EQ(read_block_size(config), 9);
  config = {.heartbeat = -1, .command = -1};
  EXPECT_EQ(read_block_size(config), 6);
  config.luff = {.offset = 20, .type = RegisterType::int16};
  EXPECT_EQ(read_block_size(config), 21);
  config.luff.type = RegisterType::uint32;
  EXPECT_EQ(read_block_size(config), 22);
}

TEST(ReadBlock, ScaleSignAndBiasAreAppliedAsDocumented) {
  PlcReadConfig config;
  config.travel = {.offset = 0, .type = RegisterType::int32, .scale = 0.001, .bias = 10.0, .sign = -1};
  config.slew = {.offset = 2, .type = RegisterType::uint16, .scale = 0.01, .bias = -180.0};
  config.luff = {.offset = 3, .type = RegisterType::int16, .scale = 0.01};
  config.heartbeat = config.command = -1;
  const std::array<std::uint16_t, 4> registers{0xFFFE, 0x1DC0, 36000, static_cast<std::uint16_t>(-1234)};
  const PlcReading reading = decode_read_block(registers, config);
  EXPECT_DOUBLE_EQ(reading.travel_m, 123.456 + 10.0);
  EXPECT_DOUBLE_EQ(reading.slew_deg, 180.0);
  EXPECT_DOUBLE_EQ(reading.luff_deg, -12.34);
  EXPECT_EQ(reading.heartbeat, 0);
  EXPECT_EQ(reading.command, 0);
}

TEST(ReadBlock, WordOrderDoesNotTouchSingleRegisters) {
  PlcReadConfig config;
  config.slew = {.offset = 2, .type = RegisterType::uint16};
  for (const auto& [order, name] : test::kWordOrders) {
    config.word_order = order;
    std::array<std::uint16_t, 8> registers{};
    registers[2] = 0x1234;
    registers[6] = 0x5678;
    registers[7] = 1;
    const PlcReading reading = decode_read_block(registers, config);
    EXPECT_EQ(reading.slew_deg, 0x1234);
    EXPECT_EQ(reading.heartbeat, 0x5678);
    EXPECT_EQ(reading.command, 1);
  }
}

TEST(ReadBlock, IsTornExactlyWhenTheTailCopyDiffers) {
  PlcReadConfig config;
  config.heartbeat_tail = 8;
  std::array<std::uint16_t, 9> registers{};
  registers[6] = registers[8] = 77;
  EXPECT_FALSE(decode_read_block(registers, config).torn);
  registers[8] = 76;
  EXPECT_TRUE(decode_read_block(registers, config).torn);
  config.heartbeat_tail = -1;
  EXPECT_FALSE(decode_read_block(registers, config).torn);
}

TEST(ReadBlock, NotANumberIsHandedOnForTheCallerToJudge) {
  // Quiet NaN 0x7FC00000, infinity 0x7F800000.
  const std::array<std::uint16_t, 8> registers{0x7FC0, 0, 0x7F80, 0, 0, 0, 0, 0};
  const PlcReading reading = decode_read_block(registers, {});
  EXPECT_TRUE(std::isnan(reading.travel_m));
  EXPECT_EQ(reading.slew_deg, kInf);
}

TEST(ReadBlock, EveryTypeAndOrderRoundTripsToWithinItsResolution) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(0.0, 300.0);
  for (const RegisterType type : kTypes) {
    for (const auto& [order, name] : test::kWordOrders) {
      for (int i = 0; i < 200; ++i) {
        PlcReadConfig config;
        config.word_order = order;
        for (JointRegister* joint : {&config.travel, &config.slew, &config.luff}) {
          joint->type = type;
          joint->scale = 0.01;
        }
        config.heartbeat_tail = 8;
        PlcReading in{.travel_m = value(random), .slew_deg = value(random), .luff_deg = value(random)};
        in.heartbeat = static_cast<std::uint16_t>(random());
        in.command = static_cast<std::uint16_t>(random() & 3u);
        in.torn = (random() & 1u) != 0;
        const PlcReading out = decode_read_block(encode_read_block(in, config), config);
        EXPECT_NEAR(out.travel_m, in.travel_m, 0.00501);
        EXPECT_NEAR(out.slew_deg, in.slew_deg, 0.00501);
        EXPECT_NEAR(out.luff_deg, in.luff_deg, 0.00501);
        EXPECT_EQ(out.heartbeat, in.heartbeat);
        EXPECT_EQ(out.command, in.command);
        EXPECT_EQ(out.torn, in.torn);
      }
    }
  }
}

TEST(WriteBlockCodec, Float32LayoutIsThatOfTheRegisterTable) {
  EXPECT_EQ(encode_write_block(sample_block(), {}), test::kSampleRegisters);
}

TEST(WriteBlockCodec, Int32HoldsTenThousandths) {
  const WriteRegisters registers = encode_write_block(sample_block(), {.encoding = WriteEncoding::int32_e4});
  EXPECT_EQ(registers[6], 0);  // 1.5 m = 15000 = 0x00003A98
  EXPECT_EQ(registers[7], 0x3A98);
  EXPECT_EQ(registers[8], 0xFFFF);  // -0.25 m = -2500 = 0xFFFFF63C
  EXPECT_EQ(registers[9], 0xF63C);
  EXPECT_EQ(registers[4], 0x0123);  // frame numbers are not scaled
  EXPECT_EQ(registers[5], 0x4567);
}

TEST(WriteBlockCodec, Int32RoundsToNearestAndSaturates) {
  const PlcWriteConfig config{.encoding = WriteEncoding::int32_e4};
  WriteBlock block = sample_block();
  block.x_m = 0.00016;
  block.y_m = -0.00016;
  block.z_m = 1e9;
  block.roll_deg = -1e300;
  const WriteBlock out = decode_write_block(encode_write_block(block, config), config);
  EXPECT_DOUBLE_EQ(out.x_m, 0.0002);
  EXPECT_DOUBLE_EQ(out.y_m, -0.0002);
  EXPECT_DOUBLE_EQ(out.z_m, 214748.3647);
  EXPECT_DOUBLE_EQ(out.roll_deg, -214748.3648);
  const WriteBlock before_first = decode_write_block(encode_write_block({}, config), config);
  EXPECT_DOUBLE_EQ(before_first.age_ms, 214748.3647);
  EXPECT_DOUBLE_EQ(before_first.q1_m, 9999.0);
  EXPECT_DOUBLE_EQ(before_first.sigma_translation_m, -1.0);
}

TEST(WriteBlockCodec, RoundTripsInEveryEncodingAndOrder) {
  for (const WriteEncoding encoding : {WriteEncoding::float32, WriteEncoding::int32_e4}) {
    for (const auto& [order, name] : test::kWordOrders) {
      const PlcWriteConfig config{.word_order = order, .encoding = encoding};
      const WriteBlock out = decode_write_block(encode_write_block(sample_block(), config), config);
      if (encoding == WriteEncoding::float32) {
        EXPECT_EQ(out, sample_block());
      } else {
        EXPECT_NEAR(out.y_m, -0.25, 1e-12);
        EXPECT_NEAR(out.age_ms, 47.5, 1e-12);
        EXPECT_EQ(out.frame, sample_block().frame);
        EXPECT_EQ(out.matched, sample_block().matched);
        EXPECT_TRUE(out.health);
      }
    }
  }
}

TEST(WriteBlockCodec, AServiceThatHasSeenNothingReportsTheAgreedFigures) {
  const WriteBlock out = decode_write_block(encode_write_block({}, {}), {});
  EXPECT_EQ(out, WriteBlock{});
  EXPECT_EQ(out.age_ms, 1e7);
  EXPECT_EQ(out.rms_m, 9999.0);
  EXPECT_EQ(out.sigma_rotation_deg, -1.0);
  EXPECT_FALSE(out.health);
}

TEST(WriteBlockCodec, APoseThatIsNotFiniteIsNeverHealthyAndBecomesZeros) {
  for (double WriteBlock::*field : {&WriteBlock::x_m, &WriteBlock::y_m, &WriteBlock::z_m,
                                    &WriteBlock::roll_deg, &WriteBlock::pitch_deg, &WriteBlock::yaw_deg}) {
    for (const double bad : {kNan, kInf, -kInf}) {
      WriteBlock block = sample_block();
      block.*field = bad;
      const WriteBlock out = decode_write_block(encode_write_block(block, {}), {});
      EXPECT_FALSE(out.health);
      EXPECT_EQ(out.state, State::lost);
      EXPECT_EQ(out.x_m, 0.0);
      EXPECT_EQ(out.yaw_deg, 0.0);
    }
  }
}

TEST(WriteBlockCodec, HealthIsOneOnlyWhileTracking) {
  for (int state = 0; state <= 7; ++state) {
    for (const bool health : {false, true}) {
      WriteBlock block = sample_block();
      block.state = static_cast<State>(state);
      block.health = health;
      const WriteBlock out = decode_write_block(encode_write_block(block, {}), {});
      EXPECT_EQ(out.health, out.state == State::tracking);
      EXPECT_EQ(out.health, health && state == 1);
    }
  }
}

TEST(WriteBlockCodec, AnUnknownAgeTakesTheHealthAway) {
  WriteBlock block = sample_block();
  block.age_ms = kNan;
  const WriteBlock out = decode_write_block(encode_write_block(block, {}), {});
  EXPECT_FALSE(out.health);
  EXPECT_EQ(out.age_ms, 1e7);
}

TEST(WriteBlockCodec, NoRealFieldIsEverNanOrInfinite) {
  std::mt19937 random(99);
  const std::array bad{kNan, kInf, -kInf, 1e300, -1e300, 3.5e38, 0.0, 1.0};
  for (int i = 0; i < 2000; ++i) {
    const auto any = [&] { return bad[random() % bad.size()]; };
    WriteBlock block = sample_block();
    for (double* field :
         {&block.x_m, &block.y_m, &block.z_m, &block.roll_deg, &block.pitch_deg, &block.yaw_deg, &block.q1_m,
          &block.mean_m, &block.median_m, &block.q3_m, &block.rms_m, &block.age_ms,
          &block.sigma_translation_m, &block.sigma_rotation_deg, &block.processing_ms}) {
      *field = any();
    }
    const WriteRegisters registers = encode_write_block(block, {});
    for (const int offset : {6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 30, 32, 34, 36}) {
      const auto at = static_cast<std::size_t>(offset);
      EXPECT_TRUE(std::isfinite(decode_float32({registers[at], registers[at + 1]}, WordOrder::abcd)));
    }
  }
}

}  // namespace
}  // namespace hulltrack
