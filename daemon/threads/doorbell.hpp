// Wakes one waiting thread: "something changed, look again".
//
// A ring while nobody waits is remembered, so none is lost; several rings before a look count as one.
// Thread rule: any thread rings, one thread waits. Time-outs are on the monotonic clock.
#pragma once

#include <condition_variable>
#include <mutex>

#include "core/base/time.hpp"

namespace hulltrack {

class Doorbell {
 public:
  void ring() {
    {
      const std::lock_guard lock(mutex_);
      rung_ = true;
    }
    changed_.notify_one();
  }

  /// Returns at once if rung since the last return, otherwise on a ring or at `deadline`. True if rung.
  bool wait_until(SteadyTime deadline) {
    std::unique_lock lock(mutex_);
    const bool rung = changed_.wait_until(lock, deadline, [this] { return rung_; });
    rung_ = false;
    return rung;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool rung_ = false;
};

}  // namespace hulltrack
