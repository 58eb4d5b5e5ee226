// The service's view of the PLC: joints in, write block out, over one Modbus link.
//
// Units as in the registers. Each request takes at most one response timeout: one in poll(), one in
// write(), where once a second a read-back precedes it. They share one connection; after an error the
// next of them reconnects (see modbus_link.hpp). Judging the values and the heartbeat's age is the
// caller's. Failure: an outcome, never an exception.
// Thread rule: one thread uses it; it has none of its own. Cost: one round trip, and a second one in
// one write a second.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plc/modbus_link.hpp"
#include "plc/plc_config.hpp"
#include "plc/register_codec.hpp"
#include "plc/write_block.hpp"

namespace hulltrack {

/// One read of the PLC's block.
struct PlcPoll {
  LinkOutcome outcome = LinkOutcome::waiting;
  int exception = 0;      // Modbus exception code
  std::string message{};  // plain words; empty with ok and waiting
  PlcReading reading{};   // meaningful with ok; drop the joints when reading.torn
  bool fresh = false;     // ok, not torn, and the heartbeat moved since the last ok poll (or there is none)
  SteadyTime requested{};
  SteadyTime answered{};

  [[nodiscard]] bool ok() const { return outcome == LinkOutcome::ok; }
  /// The middle of the request: the stamp of the joints, before plc.latency is taken off.
  [[nodiscard]] SteadyTime stamp() const { return requested + (answered - requested) / 2; }
};

/// What the read-back of our own block found.
enum class ReadBack {
  not_due,  // looked at less than a second ago, or nothing written on this connection yet
  matches,
  overwritten,  // somebody else writes there
  unreadable,   // the PLC refuses to read the block to us
};

struct PlcWrite {
  LinkOutcome outcome = LinkOutcome::waiting;
  int exception = 0;
  std::string message{};
  ReadBack read_back = ReadBack::not_due;
  std::string read_back_message{};  // with overwritten and unreadable
  SteadyTime requested{};
  SteadyTime answered{};

  [[nodiscard]] bool ok() const { return outcome == LinkOutcome::ok; }
};

class PlcClient {
 public:
  /// Does not connect. `now` as in ModbusLink. Throws std::invalid_argument when the read block does not
  /// fit one request. heartbeat_timeout 0 means that the PLC has neither heartbeat nor tail copy.
  /// `heartbeat`: ours goes on counting from here.
  explicit PlcClient(PlcConfig config, ModbusLink::Clock now = {}, std::uint16_t heartbeat = 0);

  [[nodiscard]] PlcPoll poll();

  /// Writes `block` with the next heartbeat and its copy put in. The heartbeat counts attempts, so that a
  /// write whose reply was lost is not followed by one of the same number. Once a second the block is
  /// read first: then a foreign hand had the longest time to show.
  [[nodiscard]] PlcWrite write(const WriteBlock& block);

  /// The next request is tried whenever the last one failed.
  void end_back_off() { link_.end_back_off(); }

  /// Our heartbeat of the last write that was tried.
  [[nodiscard]] std::uint16_t heartbeat() const { return heartbeat_; }
  [[nodiscard]] bool connected() const { return link_.connected(); }
  [[nodiscard]] std::uint64_t connections() const { return link_.connections(); }

 private:
  LinkResult read_back(PlcWrite& write);

  PlcConfig config_;
  ModbusLink::Clock now_;
  ModbusLink link_;
  std::vector<std::uint16_t> read_registers_;
  std::optional<std::uint16_t> last_heartbeat_;  // the PLC's, of the last ok poll
  std::uint16_t heartbeat_;                      // ours
  std::optional<WriteRegisters> last_written_;   // on this connection
  SteadyTime last_read_back_{};
};

}  // namespace hulltrack
