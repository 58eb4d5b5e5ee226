// What a site says about its PLC: [plc], [plc.read], [plc.write] of the configuration (ICD 5).
#pragma once

#include <cstdint>
#include <string>

#include "core/base/time.hpp"

namespace hulltrack {

/// Order of the bytes of a 32-bit value as they stand in two registers.
enum class WordOrder { abcd, cdab, badc, dcba };
enum class RegisterType { float32, int32, uint32, int16, uint16 };
/// How the float32 fields of the write block are written: as float32, or as int32 = value * 10000.
enum class WriteEncoding { float32, int32_e4 };

/// One joint: value = sign * scale * raw + bias, in m or deg.
struct JointRegister {
  int offset = 0;  // from the read base
  RegisterType type = RegisterType::float32;
  double scale = 1.0;
  double bias = 0.0;
  int sign = 1;         // +1 or -1
  double min = -500.0;  // m or deg
  double max = 500.0;
  double max_rate = 1.0;  // m/s or deg/s
};

struct PlcReadConfig {
  int base = 0;
  WordOrder word_order = WordOrder::abcd;
  JointRegister travel{.offset = 0, .min = -500.0, .max = 500.0, .max_rate = 1.0};
  JointRegister slew{.offset = 2, .min = -360.0, .max = 360.0, .max_rate = 3.0};
  JointRegister luff{.offset = 4, .min = -90.0, .max = 90.0, .max_rate = 3.0};
  int heartbeat = 6;        // offset
  int heartbeat_tail = -1;  // offset; -1 = the PLC has none
  int command = 7;          // offset; -1 = the PLC has none
};

struct PlcWriteConfig {
  int base = 100;
  WordOrder word_order = WordOrder::abcd;
  WriteEncoding encoding = WriteEncoding::float32;
};

struct PlcConfig {
  std::string host;
  std::uint16_t port = 502;
  int unit_id = 1;
  Nanoseconds poll_period = std::chrono::milliseconds(20);
  Nanoseconds write_period = std::chrono::milliseconds(100);
  Nanoseconds response_timeout = std::chrono::milliseconds(100);
  Nanoseconds heartbeat_timeout = std::chrono::milliseconds(500);  // 0 = no heartbeat register
  Nanoseconds latency{0};
  PlcReadConfig read{};
  PlcWriteConfig write{};
};

}  // namespace hulltrack
