// RoboSense packets written byte by byte, independent of the encoder.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace hulltrack::test {

using RobosenseBytes = std::vector<std::uint8_t>;

inline void put_be16(RobosenseBytes& bytes, std::size_t at, int value) {
  bytes[at] = static_cast<std::uint8_t>(value >> 8);
  bytes[at + 1] = static_cast<std::uint8_t>(value);
}

/// Empty data packet of the Helios family with the given block azimuths (0.01 deg), clock at 0.
inline RobosenseBytes helios_bytes(const std::array<int, 12>& azimuths) {
  RobosenseBytes bytes(1248, 0);
  constexpr std::array<std::uint8_t, 4> kId = {0x55, 0xAA, 0x05, 0x5A};
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = kId[i];
  for (std::size_t block = 0; block < 12; ++block) {
    put_be16(bytes, 42 + block * 100, 0xFFEE);
    put_be16(bytes, 42 + block * 100 + 2, azimuths[block]);
  }
  return bytes;
}

/// The same of the older models, clock at the beginning of 2024.
inline RobosenseBytes classic_bytes(const std::array<int, 12>& azimuths) {
  RobosenseBytes bytes = helios_bytes(azimuths);
  constexpr std::array<std::uint8_t, 8> kId = {0x55, 0xAA, 0x05, 0x0A, 0x5A, 0xA5, 0x50, 0xA0};
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = kId[i];
  constexpr std::array<std::uint8_t, 3> kDate = {24, 1, 1};
  for (std::size_t i = 0; i < 3; ++i) bytes[20 + i] = kDate[i];
  return bytes;
}

/// Azimuths from `first` on, `step` apart, both in 0.01 deg; `together` blocks share one.
inline std::array<int, 12> block_azimuths(int first, int step, int together = 1) {
  std::array<int, 12> azimuths{};
  for (int i = 0; i < 12; ++i) azimuths[static_cast<std::size_t>(i)] = (first + i / together * step) % 36000;
  return azimuths;
}

inline void put_echo(RobosenseBytes& bytes, std::size_t block, std::size_t slot, int distance,
                     int intensity = 50) {
  const std::size_t at = 42 + block * 100 + 4 + slot * 3;
  put_be16(bytes, at, distance);
  bytes[at + 2] = static_cast<std::uint8_t>(intensity);
}

/// DIFOP angle {sign, 0.01 deg} of one laser.
inline void put_angle(RobosenseBytes& bytes, std::size_t table, std::size_t laser, int angle) {
  bytes[table + laser * 3] = angle < 0 ? std::uint8_t{1} : std::uint8_t{0};
  put_be16(bytes, table + laser * 3 + 1, std::abs(angle));
}

inline constexpr std::size_t kVertical = 468;
inline constexpr std::size_t kHorizontal = 564;

inline RobosenseBytes empty_difop(std::uint8_t mode, int rpm = 600) {
  RobosenseBytes bytes(1248, 0xFF);
  constexpr std::array<std::uint8_t, 8> kId = {0xA5, 0xFF, 0x00, 0x5A, 0x11, 0x11, 0x55, 0x55};
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = kId[i];
  put_be16(bytes, 8, rpm);
  bytes[300] = mode;
  return bytes;
}

/// Laser k at (10 - k) deg of elevation, 0.5 deg clockwise if odd, else 0.5 deg the other way.
inline RobosenseBytes difop_bytes(std::size_t lasers, std::uint8_t mode, int rpm = 600) {
  RobosenseBytes bytes = empty_difop(mode, rpm);
  for (std::size_t k = 0; k < lasers; ++k) {
    put_angle(bytes, kVertical, k, 1000 - 100 * static_cast<int>(k));
    put_angle(bytes, kHorizontal, k, k % 2 == 1 ? 50 : -50);
  }
  return bytes;
}

/// Bpearl: laser k at (88 - 2 k) deg.
inline RobosenseBytes bpearl_difop_bytes(std::uint8_t mode, int rpm = 600) {
  RobosenseBytes bytes = difop_bytes(32, mode, rpm);
  for (std::size_t k = 0; k < 32; ++k) put_angle(bytes, kVertical, k, 8800 - 200 * static_cast<int>(k));
  return bytes;
}

/// RS16: laser k at (k - 7.5) deg, sizes of 24 bits in 0.0001 deg.
inline RobosenseBytes rs16_difop_bytes(std::uint8_t mode, int rpm = 600) {
  RobosenseBytes bytes = empty_difop(mode, rpm);
  for (std::size_t k = 0; k < 16; ++k) {
    const int size = std::abs(static_cast<int>(k) * 10000 - 75000);
    bytes[1165 + k * 3] = static_cast<std::uint8_t>(size >> 16);
    put_be16(bytes, 1165 + k * 3 + 1, size);
  }
  return bytes;
}

}  // namespace hulltrack::test
