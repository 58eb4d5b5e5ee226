// Is every thread still making progress?
//
// Each thread beats its Pulse once a turn of its loop; one that has not beaten for longer than its limit
// is overdue, and the watchdog is not fed while any is. A thread that comes back is healthy again.
// Thread rule: add() before the threads start; beat() from the owning thread; overdue() from any.
// `now` is handed in, so that the rule can be tested without waiting. Failure: none.
#pragma once

#include <atomic>
#include <deque>
#include <string>
#include <vector>

#include "core/base/time.hpp"

namespace hulltrack {

/// A turn of any loop takes some 100 ms at most; five times that is a hang.
inline constexpr Nanoseconds kTurnLimit = std::chrono::milliseconds(500);

class Pulse {
 public:
  Pulse(std::string name, Nanoseconds limit, SteadyTime now) : name_(std::move(name)), limit_(limit) {
    beat(now);
  }

  void beat(SteadyTime now) { last_.store(now.time_since_epoch().count(), std::memory_order_relaxed); }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Nanoseconds limit() const { return limit_; }
  [[nodiscard]] Nanoseconds silence(SteadyTime now) const {
    return now.time_since_epoch() - Nanoseconds{last_.load(std::memory_order_relaxed)};
  }

 private:
  std::string name_;
  Nanoseconds limit_;
  std::atomic<Nanoseconds::rep> last_{0};
};

class ThreadWatch {
 public:
  struct Overdue {
    std::string thread;
    Nanoseconds silence;  // since its last beat
  };

  /// The pulse lives as long as the watch. Counts as beaten at `now`.
  Pulse& add(std::string name, Nanoseconds limit, SteadyTime now) {
    return pulses_.emplace_back(std::move(name), limit, now);
  }

  /// The threads that have been silent for longer than their limits.
  [[nodiscard]] std::vector<Overdue> overdue(SteadyTime now) const {
    std::vector<Overdue> found;
    for (const Pulse& pulse : pulses_) {
      if (const Nanoseconds silence = pulse.silence(now); silence > pulse.limit()) {
        found.push_back({pulse.name(), silence});
      }
    }
    return found;
  }

 private:
  std::deque<Pulse> pulses_;
};

}  // namespace hulltrack
