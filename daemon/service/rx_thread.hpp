// The thread that listens: datagrams of every LiDAR -> scans for the tracker.
//
// Waits with epoll, so it costs nothing while nothing comes. A burst or a flood is taken in bounded
// bites, between which finished scans are handed over: the newest scan wins. Never throws on what it
// receives; an unusable socket throws, which ends the service in order.
// Thread rule: run() in a thread of its own; construct and destroy in the owner's.
#pragma once

#include <stop_token>
#include <vector>

#include "daemon/config/config.hpp"
#include "daemon/pipeline/lidar_watch.hpp"
#include "daemon/service/exchange.hpp"
#include "daemon/threads/thread_watch.hpp"
#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "lidar_drivers/udp_source.hpp"

namespace hulltrack {

class RxThread {
 public:
  /// Opens the sockets. Throws std::runtime_error with one line (port in use, address not of this host,
  /// calibration unreadable). References must outlive this object.
  RxThread(const Config& config, Exchange& exchange, Pulse& pulse, LogSink& log);
  ~RxThread();

  void run(std::stop_token stop);

 private:
  /// What of a socket's counters has been told.
  struct SocketMemory {
    std::uint64_t foreign = 0;
    std::uint64_t filtered = 0;
    std::uint64_t kernel_overflows = 0;
  };

  /// Sleeps until datagrams wait, takes them all; gives when it woke: nothing older is left in the sockets.
  SteadyTime receive_waiting();
  void receive(std::size_t socket);
  void tell_of_counters(std::size_t socket);
  void hand_over_scans();
  void look_at_lidars(SteadyTime now);
  void add_figures();
  [[nodiscard]] LidarCounters counters(std::size_t lidar) const;

  Exchange& exchange_;
  Pulse& pulse_;
  LogSink& log_;
  std::vector<LidarConfig> lidars_;
  UdpSources sockets_;
  std::vector<SocketMemory> memories_;
  DatagramRouter router_;
  ScanBuilder builder_;
  std::vector<LidarWatch> watches_;
  ConditionLog dropped_log_;
  RecentGrowth dropped_grows_;
  std::uint64_t dropped_ = 0;
  SteadyTime last_received_{};
  SteadyTime next_look_{};
  Figures told_;  // running totals already on the board
  int epoll_ = -1;
};

}  // namespace hulltrack
