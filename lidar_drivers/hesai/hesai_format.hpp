// Hesai's data datagrams and the tables of the models that send them.
//
// Little endian: a header (the Pandar40P has none), blocks of {azimuth in 0.01 deg, one return a laser}, a
// tail with return mode, motor speed, date and microseconds, then what the header's flags announce. A return
// is {distance u16, reflectivity u8}, of most models with a fourth byte that is not used. With n returns a
// firing n blocks in a row carry one azimuth, and repeat each other where there was only one return.
// Source: user manuals of the PandarXT, XT-16, XT32M2X, Pandar40P, Pandar64 and PandarQT; figures that they
// leave to a unit's files (angles, firing times) from the files that the maker publishes. The tails of
// Pandar40P, Pandar64 (22 bytes, 26 with the sequence number, never a signature) and PandarQT are those of
// the maker's SDK 2.0 as well. Thread rule: constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/time.hpp"

namespace hulltrack::hesai {

inline constexpr std::size_t kMaxLasers = 64;
inline constexpr std::size_t kMaxBlocks = 10;
inline constexpr std::uint16_t kHeaderFlag = 0xFFEE;  // bytes EE FF
inline constexpr std::uint16_t kBlockFlag = 0xEEFF;   // of the Pandar40P: bytes FF EE
inline constexpr std::size_t kDateBytes = 6;          // year, month, day, hour, minute, second
inline constexpr std::size_t kSequenceBytes = 4;
inline constexpr std::size_t kSignatureBytes = 32;
inline constexpr std::uint8_t kSequenceBit = 0x01;   // of the header's flags
inline constexpr std::uint8_t kSignatureBit = 0x08;  // of the header's flags

inline constexpr std::uint8_t kModeFirst = 0x33;
inline constexpr std::uint8_t kModeStrongest = 0x37;
inline constexpr std::uint8_t kModeLast = 0x38;
inline constexpr std::uint8_t kModeLastStrongest = 0x39;
inline constexpr std::uint8_t kModeLastFirst = 0x3B;
inline constexpr std::uint8_t kModeFirstStrongest = 0x3C;
inline constexpr std::uint8_t kModeTriple = 0x3D;

inline constexpr int kCentidegrees = 36000;  // one turn as the datagram counts azimuth
/// Millimetres that a unit of distance can be; the manuals know 4, 5 and 6.
inline constexpr std::uint8_t kMinDistanceUnit = 4;
inline constexpr std::uint8_t kMaxDistanceUnit = 6;
/// Faster than any of the models turns (1200 rpm) with a margin for a motor out of control.
inline constexpr double kMaxRpm = 1500.0;

struct LaserAngles {
  double elevation_deg;
  double azimuth_deg;  // to be added to the rotor's azimuth
};

/// Where the header states what; the Pandar40P's is empty, the 8-byte one has neither protocol nor flags.
struct HeaderLayout {
  std::size_t bytes, protocol, lasers, blocks, distance_unit, flags;
};

/// Offsets from the tail's begin. `bytes`: without what the flags announce.
struct TailLayout {
  std::size_t bytes, return_mode, motor_speed, date, microseconds;
};

struct ModelTable {
  std::string_view name;  // in the model registry
  std::string_view title;
  double range;  // m
  std::size_t lasers;
  std::size_t blocks;
  std::size_t return_bytes;
  std::size_t max_returns;        // a firing
  std::uint8_t protocol;          // major version in the header; 0 = it has none
  std::uint8_t distance_unit_mm;  // as delivered; where there is a header, that counts
  HeaderLayout header;
  TailLayout tail;
  int year_base;  // to which the date's first byte is added
  /// From one block (with n returns: n blocks) to the next.
  Nanoseconds block_period;
  /// What the azimuth and `firing` of a block refer to, after the datagram's time: of its last block, or
  /// of its first one.
  Nanoseconds block_time;
  bool time_is_first_blocks;
  std::array<LaserAngles, kMaxLasers> nominal;  // by design; a unit's own differ by some 0.2 deg
  std::array<Nanoseconds, kMaxLasers> firing;   // each laser's pulse after its block's reference

  [[nodiscard]] bool has_flags() const { return header.flags != 0; }
  /// Bytes of the flag before each block's azimuth.
  [[nodiscard]] std::size_t block_flag_bytes() const { return header.bytes == 0 ? 2 : 0; }
  [[nodiscard]] std::size_t block_bytes() const { return block_flag_bytes() + 2 + lasers * return_bytes; }
  [[nodiscard]] std::size_t block_offset(std::size_t block) const {
    return header.bytes + block * block_bytes();
  }
  [[nodiscard]] std::size_t azimuth_offset(std::size_t block) const {
    return block_offset(block) + block_flag_bytes();
  }
  [[nodiscard]] std::size_t return_offset(std::size_t block, std::size_t laser) const {
    return azimuth_offset(block) + 2 + laser * return_bytes;
  }
  [[nodiscard]] std::size_t tail_offset() const { return block_offset(blocks); }
  /// Without what the flags announce.
  [[nodiscard]] std::size_t bytes() const { return tail_offset() + tail.bytes; }
  /// Of a block's pulses, after its reference.
  [[nodiscard]] Nanoseconds first_pulse() const;
  [[nodiscard]] Nanoseconds last_pulse() const;
};

/// Returns a firing in this mode; 0 for a code that the maker does not use.
[[nodiscard]] std::size_t returns_of_mode(std::uint8_t mode);

/// All models, immutable, alive for the program's whole life.
[[nodiscard]] std::span<const ModelTable> models();
/// nullptr when there is none of that name.
[[nodiscard]] const ModelTable* find_model(std::string_view name);

}  // namespace hulltrack::hesai
