// How do values stand in 16-bit holding registers? Pure functions, both directions.
//
// Units as in the registers (m, deg, ms). Word order concerns values of two registers only; a 16-bit
// value is one register, as it is. Encoding never yields NaN or infinity in the write block and
// saturates where a value does not fit; decoding is total: any register content gives values, and the
// caller judges them (a float32 joint may well be NaN). Thread rule: pure. Cost: below a microsecond.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "plc/plc_config.hpp"
#include "plc/write_block.hpp"

namespace hulltrack {

using RegisterPair = std::array<std::uint16_t, 2>;

/// ABCD: the most significant byte first. CDAB: words swapped. BADC: bytes swapped. DCBA: both.
[[nodiscard]] RegisterPair encode_uint32(std::uint32_t value, WordOrder order);
[[nodiscard]] RegisterPair encode_int32(std::int32_t value, WordOrder order);
[[nodiscard]] RegisterPair encode_float32(float value, WordOrder order);
[[nodiscard]] std::uint32_t decode_uint32(RegisterPair registers, WordOrder order);
[[nodiscard]] std::int32_t decode_int32(RegisterPair registers, WordOrder order);
[[nodiscard]] float decode_float32(RegisterPair registers, WordOrder order);

/// Registers that a value of this type takes: 1 or 2.
[[nodiscard]] int register_count(RegisterType type);

// ---- PLC -> daemon, ICD 2.1

/// The PLC's values after sign, scale and bias; not checked against any range.
struct PlcReading {
  double travel_m = 0.0;
  double slew_deg = 0.0;
  double luff_deg = 0.0;
  std::uint16_t heartbeat = 0;  // 0 when the PLC has none
  std::uint16_t command = 0;    // 0 when the PLC has none
  bool torn = false;            // heartbeat and its tail copy differ: the joints are not of one moment
};

/// Most registers that one FC 03 request may ask for (Modbus application protocol 1.1b, 6.3).
inline constexpr int kMaxRegistersPerRead = 125;

/// Registers from `config.base` on that hold every configured offset. Above kMaxRegistersPerRead the
/// configuration cannot be served by one request.
[[nodiscard]] int read_block_size(const PlcReadConfig& config);

/// `registers` starts at `config.base` and holds at least read_block_size(config) registers.
/// Offsets of heartbeat, heartbeat_tail and command below 0 mean that the PLC has none.
[[nodiscard]] PlcReading decode_read_block(std::span<const std::uint16_t> registers,
                                           const PlcReadConfig& config);

/// The inverse, for a PLC in simulation: read_block_size(config) registers. Integer registers round to
/// nearest and saturate; they have no NaN and get their lowest value instead. With `reading.torn` the tail
/// copy lags one behind.
[[nodiscard]] std::vector<std::uint16_t> encode_read_block(const PlcReading& reading,
                                                           const PlcReadConfig& config);

// ---- daemon -> PLC, ICD 2.2

inline constexpr int kWriteBlockSize = 40;
using WriteRegisters = std::array<std::uint16_t, kWriteBlockSize>;

/// The last gate before the PLC. Health 1 is written only for State::tracking with a finite pose and age;
/// otherwise health is 0, and a state of tracking becomes lost (pose not finite: zeros are written) or
/// degraded. Unknown (non-finite) sigmas, distances and ages become kUnknown...; processing time 0.
/// Values beyond float32 or int32 saturate; int32 holds value * 10000 rounded to nearest.
[[nodiscard]] WriteRegisters encode_write_block(const WriteBlock& block, const PlcWriteConfig& config);

/// The inverse: exact but for the rounding of float32 or of 1e-4.
[[nodiscard]] WriteBlock decode_write_block(std::span<const std::uint16_t, kWriteBlockSize> registers,
                                            const PlcWriteConfig& config);

}  // namespace hulltrack
