// Velodyne packets written byte by byte, independent of the encoder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace hulltrack::test {

using VelodyneBytes = std::vector<std::uint8_t>;

/// Empty packet with the given block azimuths (0.01 deg).
inline VelodyneBytes velodyne_bytes(const std::array<int, 12>& azimuths, std::uint32_t timestamp_us = 0,
                                    std::uint8_t mode = 0x37, std::uint8_t product = 0x22) {
  VelodyneBytes bytes(1206, 0);
  for (std::size_t block = 0; block < 12; ++block) {
    bytes[block * 100] = 0xFF;
    bytes[block * 100 + 1] = 0xEE;
    bytes[block * 100 + 2] = static_cast<std::uint8_t>(azimuths[block]);
    bytes[block * 100 + 3] = static_cast<std::uint8_t>(azimuths[block] >> 8);
  }
  for (std::size_t i = 0; i < 4; ++i) bytes[1200 + i] = static_cast<std::uint8_t>(timestamp_us >> (8 * i));
  bytes[1204] = mode;
  bytes[1205] = product;
  return bytes;
}

/// Azimuths from `first` on, `step` apart, both in 0.01 deg.
inline std::array<int, 12> even_azimuths(int first, int step) {
  std::array<int, 12> azimuths{};
  for (int i = 0; i < 12; ++i) azimuths[static_cast<std::size_t>(i)] = (first + i * step) % 36000;
  return azimuths;
}

inline void put_return(VelodyneBytes& bytes, std::size_t block, std::size_t slot, int distance,
                       int intensity = 50) {
  const std::size_t at = block * 100 + 4 + slot * 3;
  bytes[at] = static_cast<std::uint8_t>(distance);
  bytes[at + 1] = static_cast<std::uint8_t>(distance >> 8);
  bytes[at + 2] = static_cast<std::uint8_t>(intensity);
}

}  // namespace hulltrack::test
