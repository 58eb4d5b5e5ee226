#include "plc/sim/fault_injection.hpp"

#include <modbus/modbus.h>

#include <limits>

namespace hulltrack::sim {
namespace {

bool affects_values(PlcFault fault) { return fault >= PlcFault::frozen_heartbeat; }

}  // namespace

unsigned exception_of(PlcFault fault, std::uint8_t function) {
  switch (fault) {
    case PlcFault::illegal_function:
      return MODBUS_EXCEPTION_ILLEGAL_FUNCTION;
    case PlcFault::illegal_address:
      return MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS;
    case PlcFault::illegal_value:
      return MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
    case PlcFault::busy:
      return MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY;
    case PlcFault::write_refused:
      return function == kWriteMultipleRegisters ? MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS : 0;
    default:
      return 0;
  }
}

PlcReading shown_reading(PlcFault fault, const PlcReading& current, const PlcReading& previous,
                         const PlcReadConfig& config) {
  PlcReading shown = current;
  switch (fault) {
    case PlcFault::torn_block:
      shown = previous;
      shown.travel_m = current.travel_m;
      shown.heartbeat = current.heartbeat;
      shown.torn = true;
      break;
    case PlcFault::not_a_number:
      shown.travel_m = std::numeric_limits<double>::quiet_NaN();
      break;
    case PlcFault::infinite:
      shown.travel_m = std::numeric_limits<double>::infinity();
      break;
    case PlcFault::out_of_range:
      shown.travel_m = config.travel.max + 1.0;
      break;
    default:
      break;
  }
  return shown;
}

void tear_words(std::vector<std::uint16_t>& block, const std::vector<std::uint16_t>& previous,
                const PlcReadConfig& config) {
  for (const JointRegister* joint : {&config.travel, &config.slew, &config.luff}) {
    if (register_count(joint->type) == 2) {
      const auto second = static_cast<std::size_t>(joint->offset) + 1;
      block[second] = previous[second];
    }
  }
}

void FaultInjection::set(PlcFault fault, int requests) {
  fault_ = fault;
  requests_left_ = requests;
}

PlcFault FaultInjection::meeting(const Bytes& request) const {
  const std::uint8_t function = function_of(request);
  bool meets = true;
  if (fault_ == PlcFault::write_refused) {
    meets = function == kWriteMultipleRegisters;
  } else if (affects_values(fault_)) {
    meets = function == kReadHoldingRegisters && address_of(request) == read_base_;
  }
  return meets ? fault_ : PlcFault::none;
}

bool FaultInjection::met() {
  if (requests_left_ < 0 || --requests_left_ > 0) return false;
  fault_ = PlcFault::none;
  return true;
}

std::vector<Chunk> FaultInjection::mangle(Bytes reply, PlcFault fault) {
  switch (fault) {
    case PlcFault::wrong_transaction:
      reply.front() ^= 0x55;
      break;
    case PlcFault::duplicate_reply:
      return {{.bytes = reply}, {.bytes = reply}};
    case PlcFault::truncated_reply:
      reply.resize(reply.size() / 2);
      break;
    case PlcFault::garbage_reply:
      spoil(reply);
      break;
    case PlcFault::dribbled_reply: {
      std::vector<Chunk> drops;
      for (const std::uint8_t byte : reply) {
        drops.push_back({.delay = dribble_ * (static_cast<int>(drops.size()) + 1), .bytes = {byte}});
      }
      return drops;
    }
    default:
      break;
  }
  return {{.bytes = std::move(reply)}};
}

/// Half of the time the 8 bytes that libmodbus looks at first stay correct.
void FaultInjection::spoil(Bytes& reply) {
  const bool keep_header = (random_() & 1u) != 0;
  reply.resize(keep_header ? kMbapLength + 1 + random_() % 250 : 1 + random_() % 300);
  for (std::size_t i = keep_header ? kMbapLength + 1 : 0; i < reply.size(); ++i) {
    reply[i] = static_cast<std::uint8_t>(random_());
  }
}

}  // namespace hulltrack::sim
