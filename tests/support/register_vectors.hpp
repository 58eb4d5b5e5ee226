// One block of registers in every form that a test may meet it: values, words, and a row of text.
//
// Words and row were packed by hand with Python's struct, not by the codec under test.
#pragma once

#include <array>

#include "plc/plc_config.hpp"
#include "plc/register_codec.hpp"
#include "plc/write_block.hpp"

namespace hulltrack::test {

struct NamedWordOrder {
  WordOrder order;
  const char* name;  // in the configuration
};
inline constexpr std::array kWordOrders{
    NamedWordOrder{WordOrder::abcd, "ABCD"}, NamedWordOrder{WordOrder::cdab, "CDAB"},
    NamedWordOrder{WordOrder::badc, "BADC"}, NamedWordOrder{WordOrder::dcba, "DCBA"}};

/// A healthy block whose every field is exact in float32 and in steps of 1e-4.
inline WriteBlock sample_block() {
  return {.health = true,
          .state = State::tracking,
          .faults = 0xA5C3,
          .frame = 0x01234567,
          .x_m = 1.5,
          .y_m = -0.25,
          .z_m = 0.125,
          .roll_deg = 0.5,
          .pitch_deg = -0.375,
          .yaw_deg = 2.25,
          .q1_m = 0.0625,
          .mean_m = 0.5,
          .median_m = 0.25,
          .q3_m = 0.75,
          .rms_m = 1.25,
          .matched = 0x89ABCDEF,
          .age_ms = 47.5,
          .sigma_translation_m = 0.0625,
          .sigma_rotation_deg = 0.125,
          .processing_ms = 12.5,
          .command_echo = 2,
          .heartbeat = 0xBEEF,
          .heartbeat_copy = 0xBEEF};
}

/// The same as float32 in the order ABCD: struct.pack('>HHHHIffffffffffffIffffHH', ...) word by word.
inline constexpr WriteRegisters kSampleRegisters{
    0xBEEF, 1,      1,      0xA5C3, 0x0123, 0x4567,                   // 0..5
    0x3FC0, 0x0000, 0xBE80, 0x0000, 0x3E00, 0x0000,                   // x 1.5, y -0.25, z 0.125
    0x3F00, 0x0000, 0xBEC0, 0x0000, 0x4010, 0x0000,                   // roll 0.5, pitch -0.375, yaw 2.25
    0x3D80, 0x0000, 0x3F00, 0x0000, 0x3E80, 0x0000, 0x3F40, 0x0000,   // q1, mean, median, q3
    0x3FA0, 0x0000, 0x89AB, 0xCDEF, 0x423E, 0x0000,                   // rms 1.25, matched, age 47.5
    0x3D80, 0x0000, 0x3E00, 0x0000, 0x4148, 0x0000, 2,      0xBEEF};  // sigmas, processing 12.5, echo, copy

/// The same as pymodbus_plc.py logs it, between the heartbeat and its copy (42435 = 0xA5C3, 19088743 =
/// 0x01234567, 2309737967 = 0x89ABCDEF).
inline constexpr const char* kSampleRow =
    "1,1,42435,19088743,1.5,-0.25,0.125,0.5,-0.375,2.25,0.0625,0.5,0.25,0.75,1.25,2309737967,"
    "47.5,0.0625,0.125,12.5,2";

}  // namespace hulltrack::test
