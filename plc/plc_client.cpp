#include "plc/plc_client.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace hulltrack {
namespace {

constexpr Nanoseconds kReadBackPeriod = std::chrono::seconds(1);
constexpr const char* kReadKey = "plc.read";
constexpr const char* kWriteKey = "plc.write";

PlcConfig without_unused_heartbeat(PlcConfig config) {
  if (config.heartbeat_timeout == Nanoseconds{0}) config.read.heartbeat = config.read.heartbeat_tail = -1;
  return config;
}

ModbusLinkConfig link_config(const PlcConfig& config) {
  return {.host = config.host,
          .port = config.port,
          .unit_id = config.unit_id,
          .response_timeout = config.response_timeout};
}

std::size_t checked_block_size(const PlcReadConfig& config) {
  const int size = read_block_size(config);
  if (size > kMaxRegistersPerRead) {
    throw std::invalid_argument("[plc.read] spans " + std::to_string(size) +
                                " registers; one request reads at most " +
                                std::to_string(kMaxRegistersPerRead));
  }
  return static_cast<std::size_t>(size);
}

std::string hex(std::uint16_t value) {
  char text[8];
  std::snprintf(text, sizeof text, "0x%04X", static_cast<unsigned>(value));
  return text;
}

}  // namespace

PlcClient::PlcClient(PlcConfig config, ModbusLink::Clock now, std::uint16_t heartbeat)
    : config_(without_unused_heartbeat(std::move(config))),
      now_(now ? std::move(now) : [] { return SteadyTime(std::chrono::steady_clock::now()); }),
      link_(link_config(config_), now_),
      read_registers_(checked_block_size(config_.read)),
      heartbeat_(heartbeat),
      last_read_back_(now_()) {}

PlcPoll PlcClient::poll() {
  LinkResult result = link_.read(config_.read.base, read_registers_, kReadKey);
  PlcPoll poll{.outcome = result.outcome,
               .exception = result.exception,
               .message = std::move(result.message),
               .reading = {},
               .requested = result.requested,
               .answered = result.answered};
  if (!result.link_up()) last_written_.reset();
  if (!result.ok()) return poll;
  poll.reading = decode_read_block(read_registers_, config_.read);
  const bool moved = config_.read.heartbeat < 0 || poll.reading.heartbeat != last_heartbeat_;
  poll.fresh = moved && !poll.reading.torn;
  if (!poll.reading.torn) last_heartbeat_ = poll.reading.heartbeat;
  return poll;
}

PlcWrite PlcClient::write(const WriteBlock& block) {
  PlcWrite write;
  LinkResult result = read_back(write);
  if (result.link_up()) {
    WriteBlock stamped = block;
    stamped.heartbeat = stamped.heartbeat_copy = ++heartbeat_;
    const WriteRegisters registers = encode_write_block(stamped, config_.write);
    result = link_.write(config_.write.base, registers, kWriteKey);
    if (result.ok()) last_written_ = registers;
  }
  if (!result.link_up()) last_written_.reset();
  write.outcome = result.outcome;
  write.exception = result.exception;
  write.message = std::move(result.message);
  write.requested = result.requested;
  write.answered = result.answered;
  return write;
}

/// Compares the PLC's copy of our block with what we wrote, when it is time. The result is that of the
/// link: ok, too, when nothing was due.
LinkResult PlcClient::read_back(PlcWrite& write) {
  if (!last_written_ || now_() - last_read_back_ < kReadBackPeriod) return {.outcome = LinkOutcome::ok};
  last_read_back_ = now_();
  WriteRegisters found{};
  LinkResult result = link_.read(config_.write.base, found, kWriteKey);
  if (result.outcome == LinkOutcome::exception) {
    write.read_back = ReadBack::unreadable;
    write.read_back_message = result.message;
  }
  if (!result.ok()) return result;
  const auto [theirs, ours] = std::ranges::mismatch(found, *last_written_);
  if (theirs == found.end()) {
    write.read_back = ReadBack::matches;
    return result;
  }
  const auto offset = theirs - found.begin();
  write.read_back = ReadBack::overwritten;
  write.read_back_message = "somebody else writes into our block at plc.write.base: register " +
                            std::to_string(config_.write.base + offset) + " (offset " +
                            std::to_string(offset) + ") holds " + hex(*theirs) + ", we wrote " + hex(*ours);
  return result;
}

}  // namespace hulltrack
