// A PLC for simulator and tests: a Modbus/TCP server that serves joints, takes the write block and
// misbehaves on demand.
//
// Units as in the registers. It listens when the constructor returns, on loopback unless told
// otherwise, and stops in the destructor. Whoever owns it plays the PLC's cycle by calling set_joints().
// Failure: the constructor throws std::runtime_error (port in use). Thread rule: one thread of its own
// serves; every member may be called from any thread. Cost: 128 KiB of registers.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "plc/plc_config.hpp"
#include "plc/register_codec.hpp"
#include "plc/sim/plc_fault.hpp"
#include "plc/write_block.hpp"

namespace hulltrack::sim {

struct PlcServerConfig {
  std::string bind = "127.0.0.1";  // IPv4 literal
  std::uint16_t port = 0;          // 0 = any free port, see PlcServer::port()
  PlcReadConfig read{};
  PlcWriteConfig write{};
  Nanoseconds dribble = std::chrono::milliseconds(20);  // between the bytes of a dribbled reply
};

/// One FC 16 request that covered the whole write block.
struct PlcWriteRecord {
  WriteBlock block{};
  WriteRegisters registers{};
  SteadyTime at{};           // when the request was complete
  std::uint64_t number = 0;  // 1 for the first
};

class PlcServer {
 public:
  /// For set_fault(): until another fault is set.
  static constexpr int kForever = -1;

  explicit PlcServer(PlcServerConfig config);
  ~PlcServer();
  PlcServer(const PlcServer&) = delete;
  PlcServer& operator=(const PlcServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;

  /// One PLC cycle: new joints in m and deg (any double, NaN too) and the next heartbeat.
  void set_joints(double travel_m, double slew_deg, double luff_deg);
  void set_command(std::uint16_t command);

  /// Takes effect before it returns. `requests` limits faults of replies and values: after so many
  /// requests that met the fault the server is sound again.
  void set_fault(PlcFault fault, int requests = kForever);

  /// What another Modbus master would do to any holding register.
  void poke(int address, std::uint16_t value);
  [[nodiscard]] std::uint16_t peek(int address) const;

  [[nodiscard]] std::uint64_t requests() const;     // complete requests received, answered or not
  [[nodiscard]] std::uint64_t connections() const;  // accepted so far, those closed at once included
  [[nodiscard]] int open_connections() const;       // now, as far as the server has noticed
  [[nodiscard]] int most_connections() const;       // most at the same time so far

  [[nodiscard]] std::optional<PlcWriteRecord> last_write() const;
  /// Waits until `number` writes have come; false after `limit`.
  [[nodiscard]] bool wait_for_writes(std::uint64_t number, Nanoseconds limit) const;
  /// Called on the server's thread for each write, before its reply is sent; it must not call the server.
  void on_write(std::function<void(const PlcWriteRecord&)> callback);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hulltrack::sim
