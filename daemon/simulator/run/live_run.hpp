// A simulation in real time on the network: the LiDARs' datagrams over UDP, the loader's PLC as a Modbus
// server.
//
// Datagrams leave when their last firing is due; the PLC latches its encoders every PLC cycle. Whatever the
// service writes is compared with the truth. Blocks until the run is over or `keep_going` says no; asked
// once a second, together with `show`. Failure: one line (port in use, address unusable).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/result.hpp"
#include "daemon/simulator/run/simulated_berth.hpp"

namespace hulltrack {

struct LiveOptions {
  std::string lidar_host = "127.0.0.1";
  std::uint16_t lidar_port = 2368;  // of the first LiDAR, the next ones' follow
  bool with_plc = true;             // false: somebody's own PLC serves the service
  std::string plc_bind = "127.0.0.1";
  std::uint16_t plc_port = 1502;  // 0 = any free one
  bool wait_for_service = false;  // the run begins when the service first reads the PLC
};

struct LiveHooks {
  /// Called once, before anything is simulated; an error ends the run. `plc_port`: the bound one.
  std::function<Result<void>(std::uint16_t plc_port)> listening;
  std::function<void(const std::string& line)> show;
  std::function<bool()> keep_going;
};

[[nodiscard]] Result<void> run_live(const SimulatedBerth& berth, const LiveOptions& options,
                                    const LiveHooks& hooks);

}  // namespace hulltrack
