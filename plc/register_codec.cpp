#include "plc/register_codec.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace hulltrack {
namespace {

constexpr double kInt32Scale = 1e4;  // register counts per m, deg or ms in the int32 encoding

// Offsets in the write block, ICD 2.2.
constexpr int kHeartbeat = 0, kHealth = 1, kState = 2, kFaults = 3, kFrame = 4;
constexpr int kX = 6, kY = 8, kZ = 10, kRoll = 12, kPitch = 14, kYaw = 16;
constexpr int kQ1 = 18, kMean = 20, kMedian = 22, kQ3 = 24, kRms = 26, kMatched = 28, kAge = 30;
constexpr int kSigmaTranslation = 32, kSigmaRotation = 34, kProcessing = 36, kCommandEcho = 38, kCopy = 39;

std::uint16_t swap_bytes(std::uint16_t word) { return static_cast<std::uint16_t>((word << 8) | (word >> 8)); }

bool words_swapped(WordOrder order) { return order == WordOrder::cdab || order == WordOrder::dcba; }
bool bytes_swapped(WordOrder order) { return order == WordOrder::badc || order == WordOrder::dcba; }

/// Saturates to the integer type, rounds to nearest; NaN gives the lowest value.
template <typename Integer>
Integer saturate(double value) {
  constexpr auto lowest = std::numeric_limits<Integer>::lowest();
  constexpr auto highest = std::numeric_limits<Integer>::max();
  if (!(value > static_cast<double>(lowest))) return lowest;  // NaN too
  if (value >= static_cast<double>(highest)) return highest;
  return static_cast<Integer>(std::llround(value));
}

/// Infinity beyond the range of float32 would be undefined or infinite: saturate instead. NaN stays NaN.
float to_float32(double value) {
  constexpr double kMax = std::numeric_limits<float>::max();
  return std::isinf(value) ? static_cast<float>(value) : static_cast<float>(std::clamp(value, -kMax, kMax));
}

double finite_or(double value, double fallback) { return std::isfinite(value) ? value : fallback; }

bool pose_is_finite(const WriteBlock& b) {
  return std::isfinite(b.x_m) && std::isfinite(b.y_m) && std::isfinite(b.z_m) && std::isfinite(b.roll_deg) &&
         std::isfinite(b.pitch_deg) && std::isfinite(b.yaw_deg);
}

/// The block with every rule of encode_write_block() applied, before it becomes registers.
WriteBlock made_safe(WriteBlock b) {
  const bool pose_finite = pose_is_finite(b);
  b.health = b.health && b.state == State::tracking && pose_finite && std::isfinite(b.age_ms);
  if (b.state == State::tracking && !b.health) b.state = pose_finite ? State::degraded : State::lost;
  if (!pose_finite) b.x_m = b.y_m = b.z_m = b.roll_deg = b.pitch_deg = b.yaw_deg = 0.0;
  for (double* distance : {&b.q1_m, &b.mean_m, &b.median_m, &b.q3_m, &b.rms_m}) {
    *distance = finite_or(*distance, kUnknownDistance);
  }
  b.age_ms = finite_or(b.age_ms, kUnknownAgeMs);
  b.sigma_translation_m = finite_or(b.sigma_translation_m, kUnknownSigma);
  b.sigma_rotation_deg = finite_or(b.sigma_rotation_deg, kUnknownSigma);
  b.processing_ms = finite_or(b.processing_ms, 0.0);
  return b;
}

RegisterPair pair_at(std::span<const std::uint16_t> registers, int offset) {
  const auto at = static_cast<std::size_t>(offset);
  return {registers[at], registers[at + 1]};
}

void put(std::span<std::uint16_t> registers, int offset, RegisterPair pair) {
  const auto at = static_cast<std::size_t>(offset);
  registers[at] = pair[0];
  registers[at + 1] = pair[1];
}

double decode_raw(std::span<const std::uint16_t> registers, const JointRegister& joint, WordOrder order) {
  const std::uint16_t word = registers[static_cast<std::size_t>(joint.offset)];
  switch (joint.type) {
    case RegisterType::float32:
      return static_cast<double>(decode_float32(pair_at(registers, joint.offset), order));
    case RegisterType::int32:
      return decode_int32(pair_at(registers, joint.offset), order);
    case RegisterType::uint32:
      return decode_uint32(pair_at(registers, joint.offset), order);
    case RegisterType::int16:
      return static_cast<std::int16_t>(word);
    case RegisterType::uint16:
      return word;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double decode_joint(std::span<const std::uint16_t> registers, const JointRegister& joint, WordOrder order) {
  return joint.sign * joint.scale * decode_raw(registers, joint, order) + joint.bias;
}

void encode_joint(std::span<std::uint16_t> registers, double value, const JointRegister& joint,
                  WordOrder order) {
  const double raw = (value - joint.bias) / (joint.sign * joint.scale);
  std::uint16_t& word = registers[static_cast<std::size_t>(joint.offset)];
  switch (joint.type) {
    case RegisterType::float32:
      put(registers, joint.offset, encode_float32(to_float32(raw), order));
      break;
    case RegisterType::int32:
      put(registers, joint.offset, encode_int32(saturate<std::int32_t>(raw), order));
      break;
    case RegisterType::uint32:
      put(registers, joint.offset, encode_uint32(saturate<std::uint32_t>(raw), order));
      break;
    case RegisterType::int16:
      word = static_cast<std::uint16_t>(saturate<std::int16_t>(raw));
      break;
    case RegisterType::uint16:
      word = saturate<std::uint16_t>(raw);
      break;
  }
}

}  // namespace

RegisterPair encode_uint32(std::uint32_t value, WordOrder order) {
  RegisterPair pair{static_cast<std::uint16_t>(value >> 16), static_cast<std::uint16_t>(value & 0xFFFFu)};
  if (bytes_swapped(order)) pair = {swap_bytes(pair[0]), swap_bytes(pair[1])};
  if (words_swapped(order)) std::swap(pair[0], pair[1]);
  return pair;
}

std::uint32_t decode_uint32(RegisterPair pair, WordOrder order) {
  if (words_swapped(order)) std::swap(pair[0], pair[1]);
  if (bytes_swapped(order)) pair = {swap_bytes(pair[0]), swap_bytes(pair[1])};
  return static_cast<std::uint32_t>(pair[0]) << 16 | pair[1];
}

RegisterPair encode_int32(std::int32_t value, WordOrder order) {
  return encode_uint32(static_cast<std::uint32_t>(value), order);
}
RegisterPair encode_float32(float value, WordOrder order) {
  return encode_uint32(std::bit_cast<std::uint32_t>(value), order);
}
std::int32_t decode_int32(RegisterPair registers, WordOrder order) {
  return static_cast<std::int32_t>(decode_uint32(registers, order));
}
float decode_float32(RegisterPair registers, WordOrder order) {
  return std::bit_cast<float>(decode_uint32(registers, order));
}

int register_count(RegisterType type) {
  return type == RegisterType::int16 || type == RegisterType::uint16 ? 1 : 2;
}

int read_block_size(const PlcReadConfig& config) {
  int size = 0;
  for (const JointRegister* joint : {&config.travel, &config.slew, &config.luff}) {
    size = std::max(size, joint->offset + register_count(joint->type));
  }
  for (const int offset : {config.heartbeat, config.heartbeat_tail, config.command}) {
    size = std::max(size, offset + 1);
  }
  return size;
}

PlcReading decode_read_block(std::span<const std::uint16_t> registers, const PlcReadConfig& config) {
  assert(registers.size() >= static_cast<std::size_t>(read_block_size(config)));
  const auto word = [&](int offset) -> std::uint16_t {
    return offset < 0 ? std::uint16_t{0} : registers[static_cast<std::size_t>(offset)];
  };
  return {.travel_m = decode_joint(registers, config.travel, config.word_order),
          .slew_deg = decode_joint(registers, config.slew, config.word_order),
          .luff_deg = decode_joint(registers, config.luff, config.word_order),
          .heartbeat = word(config.heartbeat),
          .command = word(config.command),
          .torn = config.heartbeat >= 0 && config.heartbeat_tail >= 0 &&
                  word(config.heartbeat) != word(config.heartbeat_tail)};
}

std::vector<std::uint16_t> encode_read_block(const PlcReading& reading, const PlcReadConfig& config) {
  std::vector<std::uint16_t> registers(static_cast<std::size_t>(read_block_size(config)));
  const auto put_word = [&](int offset, std::uint16_t value) {
    if (offset >= 0) registers[static_cast<std::size_t>(offset)] = value;
  };
  encode_joint(registers, reading.travel_m, config.travel, config.word_order);
  encode_joint(registers, reading.slew_deg, config.slew, config.word_order);
  encode_joint(registers, reading.luff_deg, config.luff, config.word_order);
  put_word(config.heartbeat, reading.heartbeat);
  put_word(config.command, reading.command);
  put_word(config.heartbeat_tail, static_cast<std::uint16_t>(reading.heartbeat - (reading.torn ? 1 : 0)));
  return registers;
}

WriteRegisters encode_write_block(const WriteBlock& block, const PlcWriteConfig& config) {
  const WriteBlock b = made_safe(block);
  WriteRegisters registers{};
  const auto put_real = [&](int offset, double value) {
    put(registers, offset,
        config.encoding == WriteEncoding::float32
            ? encode_float32(to_float32(value), config.word_order)
            : encode_int32(saturate<std::int32_t>(value * kInt32Scale), config.word_order));
  };
  registers[kHeartbeat] = b.heartbeat;
  registers[kHealth] = b.health ? 1 : 0;
  registers[kState] = static_cast<std::uint16_t>(b.state);
  registers[kFaults] = b.faults;
  put(registers, kFrame, encode_uint32(b.frame, config.word_order));
  put_real(kX, b.x_m);
  put_real(kY, b.y_m);
  put_real(kZ, b.z_m);
  put_real(kRoll, b.roll_deg);
  put_real(kPitch, b.pitch_deg);
  put_real(kYaw, b.yaw_deg);
  put_real(kQ1, b.q1_m);
  put_real(kMean, b.mean_m);
  put_real(kMedian, b.median_m);
  put_real(kQ3, b.q3_m);
  put_real(kRms, b.rms_m);
  put(registers, kMatched, encode_uint32(b.matched, config.word_order));
  put_real(kAge, b.age_ms);
  put_real(kSigmaTranslation, b.sigma_translation_m);
  put_real(kSigmaRotation, b.sigma_rotation_deg);
  put_real(kProcessing, b.processing_ms);
  registers[kCommandEcho] = b.command_echo;
  registers[kCopy] = b.heartbeat_copy;
  return registers;
}

WriteBlock decode_write_block(std::span<const std::uint16_t, kWriteBlockSize> registers,
                              const PlcWriteConfig& config) {
  const auto real = [&](int offset) {
    const RegisterPair pair = pair_at(registers, offset);
    return config.encoding == WriteEncoding::float32
               ? static_cast<double>(decode_float32(pair, config.word_order))
               : decode_int32(pair, config.word_order) / kInt32Scale;
  };
  WriteBlock b;
  b.heartbeat = registers[kHeartbeat];
  b.health = registers[kHealth] == 1;
  b.state = static_cast<State>(registers[kState]);
  b.faults = registers[kFaults];
  b.frame = decode_uint32(pair_at(registers, kFrame), config.word_order);
  b.x_m = real(kX);
  b.y_m = real(kY);
  b.z_m = real(kZ);
  b.roll_deg = real(kRoll);
  b.pitch_deg = real(kPitch);
  b.yaw_deg = real(kYaw);
  b.q1_m = real(kQ1);
  b.mean_m = real(kMean);
  b.median_m = real(kMedian);
  b.q3_m = real(kQ3);
  b.rms_m = real(kRms);
  b.matched = decode_uint32(pair_at(registers, kMatched), config.word_order);
  b.age_ms = real(kAge);
  b.sigma_translation_m = real(kSigmaTranslation);
  b.sigma_rotation_deg = real(kSigmaRotation);
  b.processing_ms = real(kProcessing);
  b.command_echo = registers[kCommandEcho];
  b.heartbeat_copy = registers[kCopy];
  return b;
}

}  // namespace hulltrack
