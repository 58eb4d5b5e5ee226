// Casts datagrams ahead of the moment when they are due, on a thread of its own.
//
// take() hands them out in the order in which they leave. A bounded number is kept ready, so that a busy
// moment of the host does not delay the next datagram. An exception of the casting thread is thrown again by
// take(). Thread rule: one taker; the destructor ends the thread.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "daemon/simulator/run/departures.hpp"

namespace hulltrack {

class PacketsAhead {
 public:
  static constexpr std::size_t kReady = 3000;  // 1 to 4 s, some 10 MB

  struct Ready {
    Departure departure;
    SimulatedBerth::Packet bytes;
  };

  /// `berth` must outlive this.
  explicit PacketsAhead(const SimulatedBerth& berth);

  /// Waits until `count` datagrams (at most kReady) or all that are left are ready.
  void wait_ready(std::size_t count);

  /// The next datagram, waiting for it if need be; nothing at the end of the run.
  [[nodiscard]] std::optional<Ready> take();

 private:
  void cast_all(const std::stop_token& stop);

  const SimulatedBerth* berth_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Ready> ready_;
  bool finished_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // last: starts when everything else is there, ends before it goes
};

}  // namespace hulltrack
