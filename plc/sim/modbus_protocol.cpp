#include "plc/sim/modbus_protocol.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

namespace hulltrack::sim {
namespace {

constexpr int kRegisters = 65536;
constexpr std::size_t kShortestRequest = 12;  // with first register and count

}  // namespace

ModbusProtocol::ModbusProtocol()
    : context_(modbus_new_tcp(nullptr, 0)), registers_(modbus_mapping_new(0, 0, kRegisters, 0)) {
  if (context_ == nullptr || registers_ == nullptr ||
      socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair_) != 0) {
    release();
    throw std::runtime_error("cannot create the Modbus server: out of memory or descriptors");
  }
  modbus_set_response_timeout(context_, 0, 1000);  // libmodbus sleeps this long after some exceptions
}

ModbusProtocol::~ModbusProtocol() { release(); }

void ModbusProtocol::release() {
  if (context_ != nullptr) modbus_free(context_);
  if (registers_ != nullptr) modbus_mapping_free(registers_);
  for (const int fd : pair_) {
    if (fd >= 0) close(fd);
  }
}

Bytes ModbusProtocol::receive(int fd) {
  Bytes request(MODBUS_TCP_MAX_ADU_LENGTH);
  modbus_set_socket(context_, fd);
  request_length_ = modbus_receive(context_, request.data());
  if (request_length_ <= static_cast<int>(kMbapLength)) return {};
  request.resize(std::max(static_cast<std::size_t>(request_length_), kShortestRequest));
  return request;
}

Bytes ModbusProtocol::reply(const Bytes& request, unsigned exception) {
  modbus_set_socket(context_, pair_[0]);
  if (exception != 0) {
    modbus_reply_exception(context_, request.data(), exception);
  } else {
    modbus_reply(context_, request.data(), request_length_, registers_);
  }
  Bytes bytes(MODBUS_TCP_MAX_ADU_LENGTH);
  const ssize_t length = recv(pair_[1], bytes.data(), bytes.size(), MSG_DONTWAIT);
  bytes.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
  return bytes;
}

std::uint16_t& ModbusProtocol::at(int address) {
  return registers_->tab_registers[address & (kRegisters - 1)];
}

}  // namespace hulltrack::sim
