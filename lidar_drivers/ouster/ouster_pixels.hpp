// What one pixel of each profile says: ranges and reflectivities, for the decoder's inner loop.
//
// Precondition: the span holds kBytes from `at` on. Cost: a few instructions.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lidar_drivers/bytes.hpp"

namespace hulltrack::ouster {

struct PixelReturn {
  std::uint32_t range;  // mm; 0 = no return
  std::uint8_t reflectivity;
};

/// Reflectivity: its low byte. Firmware before 2.1 has 16 bits there, on a scale of its own.
struct LegacyPixel {
  static constexpr std::size_t kBytes = 12;
  static constexpr bool kDual = false;
  static PixelReturn read(Bytes bytes, std::size_t at) {
    return {read_le32(bytes, at) & 0xFFFFF, bytes[at + 4]};
  }
};

struct Rng19Pixel {
  static constexpr std::size_t kBytes = 12;
  static constexpr bool kDual = false;
  static PixelReturn read(Bytes bytes, std::size_t at) {
    return {read_le32(bytes, at) & 0x7FFFF, bytes[at + 4]};
  }
};

struct Rng19DualPixel {
  static constexpr std::size_t kBytes = 16;
  static constexpr bool kDual = true;
  static PixelReturn read(Bytes bytes, std::size_t at) {
    return {read_le32(bytes, at) & 0x7FFFF, bytes[at + 3]};
  }
  static PixelReturn read_second(Bytes bytes, std::size_t at) { return read(bytes, at + 4); }
};

struct Rng15Pixel {
  static constexpr std::size_t kBytes = 4;
  static constexpr bool kDual = false;
  static PixelReturn read(Bytes bytes, std::size_t at) {
    return {(read_le16(bytes, at) & 0x7FFFU) * 8U, bytes[at + 2]};
  }
};

}  // namespace hulltrack::ouster
