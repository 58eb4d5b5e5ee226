// One Modbus/TCP connection to the PLC that survives whatever the PLC or the network does.
//
// A read is one FC 03, a write one FC 16. No call takes longer than one response timeout, connecting
// included: libmodbus runs without a byte timeout, so that the response timeout bounds the whole reply,
// truncated or dribbled. Every error except an exception reply closes the socket, so that a late or
// duplicate reply can never be taken for the next one's; the next call reconnects, at once after a first
// error, then after 0.2 s doubling to 1 s until an exchange succeeds. Never more than one socket.
// Failure: an outcome with a plain line, never an exception or SIGPIPE. Thread rule: one thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/base/time.hpp"

namespace hulltrack {

enum class LinkOutcome {
  ok,
  exception,    // the PLC refused this request; the connection is fine
  timeout,      // connected, but no complete reply within the response timeout
  garbled,      // a reply to another request, or not Modbus
  closed,       // reset or closed by the PLC
  unreachable,  // no connection: refused, no answer, unknown host
  waiting,      // backing off: nothing was tried
};

/// The exception code of a PLC that cannot answer just now.
inline constexpr int kExceptionBusy = 6;

/// Lower-case words for logs.
[[nodiscard]] const char* outcome_name(LinkOutcome outcome);

struct LinkResult {
  LinkOutcome outcome = LinkOutcome::waiting;
  int exception = 0;       // Modbus exception code with LinkOutcome::exception, otherwise 0
  std::string message{};   // plain words, without the PLC's address; empty with ok and waiting
  SteadyTime requested{};  // just before the request was sent; meaningful with ok and exception
  SteadyTime answered{};   // just after the reply was complete

  [[nodiscard]] bool ok() const { return outcome == LinkOutcome::ok; }
  /// A reply came, so the PLC is there.
  [[nodiscard]] bool link_up() const { return ok() || outcome == LinkOutcome::exception; }
};

struct ModbusLinkConfig {
  std::string host;  // name, IPv4 or IPv6 literal
  std::uint16_t port = 502;
  int unit_id = 1;
  Nanoseconds response_timeout = std::chrono::milliseconds(100);
};

class ModbusLink {
 public:
  using Clock = std::function<SteadyTime()>;

  /// `now` decides back-off and stamps; the default is std::chrono::steady_clock. Does not connect.
  /// Throws std::invalid_argument for a unit id other than 0..247 and 255 or a timeout that is not positive.
  explicit ModbusLink(ModbusLinkConfig config, Clock now = {});
  ~ModbusLink();
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;

  /// Fills `registers` from `address` on; untouched unless the outcome is ok. `key` names the
  /// configuration section that chose the block, for messages: "plc.read".
  [[nodiscard]] LinkResult read(int address, std::span<std::uint16_t> registers, const char* key);
  [[nodiscard]] LinkResult write(int address, std::span<const std::uint16_t> registers, const char* key);

  /// The next call tries to connect even if it is too early: for the last word of a service that ends.
  void end_back_off();

  [[nodiscard]] bool connected() const;
  /// Connections made so far: grows by one with every reconnect.
  [[nodiscard]] std::uint64_t connections() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hulltrack
