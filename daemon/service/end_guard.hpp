// Ends the process when its orderly end takes too long.
//
// The service manager would do so by SIGKILL (TimeoutStopSec= of the unit), and nobody would know why. A PLC
// that does not answer can hold up the last write for several response timeouts, a stuck thread for ever.
// Thread rule: made and destroyed by one thread; `last_resort` runs in a thread of its own and must not
// return to anything that the first thread may have destroyed.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "core/base/time.hpp"

namespace hulltrack {

class EndGuard {
 public:
  /// `last_resort` is called once, unless this object goes within `patience`.
  EndGuard(Nanoseconds patience, std::function<void()> last_resort)
      : thread_([this, patience, last_resort = std::move(last_resort)](const std::stop_token& stop) {
          std::unique_lock lock(mutex_);
          if (!ended_.wait_for(lock, stop, patience, [] { return false; }) && !stop.stop_requested()) {
            last_resort();
          }
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace hulltrack
