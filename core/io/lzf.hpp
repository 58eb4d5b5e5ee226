// Decompression of LZF, the method of DATA binary_compressed in PCD files.
//
// Format: M. Lehmann, liblzf: a control byte below 32 announces that many + 1 literals; any other a copy
// of (control >> 5) + 2 bytes (a length of 7 continues in the next byte) from a distance of
// ((control & 31) << 8 | next byte) + 1 back.
#pragma once

#include <cstdint>
#include <span>

namespace hulltrack {

/// A byte of LZF expands to fewer than this many: a three-byte copy gives at most 264.
inline constexpr std::size_t kLzfMaxRatio = 88;

/// True if `in` expands to exactly out.size() bytes; out is rubbish otherwise. Safe on any input.
[[nodiscard]] bool lzf_decompress(std::span<const std::uint8_t> in, std::span<std::uint8_t> out);

}  // namespace hulltrack
