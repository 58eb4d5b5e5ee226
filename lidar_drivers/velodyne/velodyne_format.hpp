// Velodyne's data packet and the tables of the models that send it.
//
// 1206 bytes, little endian: 12 blocks of {flag 0xEEFF, azimuth in 0.01 deg, 32 x {distance u16,
// intensity u8}}, then the time stamp (us since the hour, first firing of block 0), the return mode and the
// product code. With dual return blocks come in pairs of one azimuth: even = last, odd = strongest return.
// Source: user manuals of the VLP-16 (63-9243), HDL-32E (63-9113) and VLP-32C (63-9325).
// Thread rule: constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/time.hpp"

namespace hulltrack::velodyne {

inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kSlots = 32;  // returns in a block
inline constexpr std::size_t kSlotBytes = 3;
inline constexpr std::size_t kBlockHeaderBytes = 4;
inline constexpr std::size_t kBlockBytes = kBlockHeaderBytes + kSlots * kSlotBytes;
inline constexpr std::size_t kTimestampOffset = kBlocks * kBlockBytes;
inline constexpr std::size_t kReturnModeOffset = kTimestampOffset + 4;
inline constexpr std::size_t kProductOffset = kReturnModeOffset + 1;
inline constexpr std::size_t kPacketBytes = kProductOffset + 1;
static_assert(kPacketBytes == 1206);

inline constexpr std::uint16_t kBlockFlag = 0xEEFF;
inline constexpr int kCentidegrees = 36000;  // one turn as the packet counts azimuth
inline constexpr std::uint8_t kModeStrongest = 0x37;
inline constexpr std::uint8_t kModeLast = 0x38;
inline constexpr std::uint8_t kModeDual = 0x39;
inline constexpr Nanoseconds kClockWrap = std::chrono::hours(1);
/// Faster than any of the models turns (1200 rpm) with a margin for a motor out of control.
inline constexpr double kMaxRpm = 1500.0;

/// The pulse behind one slot of a block.
struct Slot {
  std::uint8_t channel;  // laser
  double elevation_deg;
  double azimuth_offset_deg;  // to be added to the rotor's azimuth
  double vertical_offset_m;   // to be added to z
  Nanoseconds time;           // after the block's first firing
};

struct ModelTable {
  std::string_view name;  // in the model registry
  std::string_view title;
  std::uint8_t product;      // code in the packet's last byte
  double distance_unit;      // m
  Nanoseconds block_period;  // one block (with dual return: one pair of blocks) to the next
  double range;              // m
  int channels;
  std::array<Slot, kSlots> slots;
};

/// All models, immutable, alive for the program's whole life.
[[nodiscard]] std::span<const ModelTable> models();
/// nullptr when there is none of that name.
[[nodiscard]] const ModelTable* find_model(std::string_view name);

}  // namespace hulltrack::velodyne
