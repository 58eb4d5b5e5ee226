// A loader on the bench for tests of the service: a PLC that cycles, a LiDAR in a room, both on loopback.
//
// Waits are on registers, never on time; a wait that takes a minute has failed.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "daemon/service/preparer.hpp"
#include "plc/sim/plc_server.hpp"
#include "tests/support/room_lidar.hpp"

namespace hulltrack {

/// Joints at 0 and a heartbeat every 10 ms, as a PLC's cycle makes them.
class CyclingPlc {
 public:
  /// port 0 = any free one.
  explicit CyclingPlc(std::uint16_t port = 0);

  [[nodiscard]] sim::PlcServer& server() { return server_; }

  /// Waits for a write from now on that fulfils `law`; nothing after a minute.
  std::optional<WriteBlock> wait_for(const std::function<bool(const WriteBlock&)>& law);
  /// The same among all writes but the first `seen`, which may have come already.
  std::optional<WriteBlock> wait_for(const std::function<bool(const WriteBlock&)>& law, std::size_t seen);
  /// Every block written so far, in order.
  [[nodiscard]] std::vector<WriteBlock> blocks() const;

 private:
  sim::PlcServer server_;
  mutable std::mutex mutex_;
  std::condition_variable written_;
  std::vector<WriteBlock> blocks_;
  std::jthread cycle_;
};

/// For a test that waited for health in vain: skips it if scans came faster than this machine processed them,
/// which is no place for a live run; otherwise it has failed.
void judge_missing_health(const CyclingPlc& plc);

/// The room as map, the room's LiDAR on `lidar_port`, a PLC on `plc_port`.
[[nodiscard]] Prepared room_service(std::uint16_t lidar_port, std::uint16_t plc_port);

}  // namespace hulltrack
