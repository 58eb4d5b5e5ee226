// Integers in byte streams, whatever the host's own byte order.
//
// Precondition of every function: the span is long enough for offset + size. Cost: compiles to one load.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hulltrack {

using Bytes = std::span<const std::uint8_t>;

[[nodiscard]] inline std::uint16_t read_le16(Bytes bytes, std::size_t offset) {
  assert(offset + 2 <= bytes.size());
  return static_cast<std::uint16_t>(bytes[offset] | bytes[offset + 1] << 8);
}

[[nodiscard]] inline std::uint32_t read_le32(Bytes bytes, std::size_t offset) {
  return read_le16(bytes, offset) | static_cast<std::uint32_t>(read_le16(bytes, offset + 2)) << 16;
}

[[nodiscard]] inline std::uint16_t read_be16(Bytes bytes, std::size_t offset) {
  assert(offset + 2 <= bytes.size());
  return static_cast<std::uint16_t>(bytes[offset] << 8 | bytes[offset + 1]);
}

[[nodiscard]] inline std::uint32_t read_be32(Bytes bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(read_be16(bytes, offset)) << 16 | read_be16(bytes, offset + 2);
}

inline void write_le16(std::span<std::uint8_t> bytes, std::size_t offset, std::uint16_t value) {
  assert(offset + 2 <= bytes.size());
  bytes[offset] = static_cast<std::uint8_t>(value);
  bytes[offset + 1] = static_cast<std::uint8_t>(value >> 8);
}

inline void write_le32(std::span<std::uint8_t> bytes, std::size_t offset, std::uint32_t value) {
  write_le16(bytes, offset, static_cast<std::uint16_t>(value));
  write_le16(bytes, offset + 2, static_cast<std::uint16_t>(value >> 16));
}

inline void write_be16(std::span<std::uint8_t> bytes, std::size_t offset, std::uint16_t value) {
  assert(offset + 2 <= bytes.size());
  bytes[offset] = static_cast<std::uint8_t>(value >> 8);
  bytes[offset + 1] = static_cast<std::uint8_t>(value);
}

inline void write_be32(std::span<std::uint8_t> bytes, std::size_t offset, std::uint32_t value) {
  write_be16(bytes, offset, static_cast<std::uint16_t>(value >> 16));
  write_be16(bytes, offset + 2, static_cast<std::uint16_t>(value));
}

}  // namespace hulltrack
