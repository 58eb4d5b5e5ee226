// Modbus/TCP requests in, reply bytes out, over a bank of 65536 holding registers.
//
// libmodbus parses and answers; its replies go into a socket pair first, so that a fault can get at the
// bytes before the client does. Failure: the constructor throws std::runtime_error; bad requests give
// empty or exception replies. Thread rule: external locking.
#pragma once

#include <modbus/modbus.h>

#include <cstdint>
#include <vector>

namespace hulltrack::sim {

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::size_t kMbapLength = 7;  // bytes before the function code
inline constexpr std::uint8_t kReadHoldingRegisters = 3;
inline constexpr std::uint8_t kWriteMultipleRegisters = 16;

// Parts of a request from ModbusProtocol::receive(); first register and count are those of FC 03 and FC 16.
[[nodiscard]] inline std::uint8_t function_of(const Bytes& request) { return request[kMbapLength]; }
[[nodiscard]] inline int address_of(const Bytes& request) { return request[8] << 8 | request[9]; }
[[nodiscard]] inline int count_of(const Bytes& request) { return request[10] << 8 | request[11]; }

class ModbusProtocol {
 public:
  ModbusProtocol();
  ~ModbusProtocol();
  ModbusProtocol(const ModbusProtocol&) = delete;
  ModbusProtocol& operator=(const ModbusProtocol&) = delete;

  /// One request from a readable socket: at least its 12 bytes up to the count (shorter ones of other
  /// functions are padded with zeros). Empty when the client is gone or does not speak Modbus.
  [[nodiscard]] Bytes receive(int fd);

  /// The reply's bytes; a write changes the registers first. `exception` 0 = a normal reply.
  [[nodiscard]] Bytes reply(const Bytes& request, unsigned exception);

  /// `address` 0..65535.
  [[nodiscard]] std::uint16_t& at(int address);

 private:
  void release();

  modbus_t* context_;
  modbus_mapping_t* registers_;
  int pair_[2] = {-1, -1};
  int request_length_ = 0;  // of the last request, without padding
};

}  // namespace hulltrack::sim
