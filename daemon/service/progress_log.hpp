// A thread that makes no progress, in the log: one line when it is overdue, one when it goes on.
//
// Says how long the thread has been silent and what follows for the service. Each thread is a condition of
// its own (ConditionLog), so one that relapses again and again writes no storm. Pure logic over an injected
// time. Thread rule: one owner. Cost: nothing to speak of while all threads make progress.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/log/condition_log.hpp"
#include "daemon/threads/thread_watch.hpp"

namespace hulltrack {

class ProgressLog {
 public:
  /// `sink` must outlive this object. `watchdog_timeout`: the service manager restarts a service that has
  /// not fed it for so long; nothing if nobody watches.
  ProgressLog(LogSink& sink, std::optional<Nanoseconds> watchdog_timeout)
      : sink_(sink), watchdog_timeout_(watchdog_timeout) {}

  /// The threads that are overdue now. Call it some times a second, also while none is: a thread that is
  /// not among them makes progress.
  void update(const std::vector<ThreadWatch::Overdue>& overdue, SteadyTime now);

 private:
  struct Thread {
    ConditionLog log;
    bool overdue = false;
    Nanoseconds silence{0};  // when it was last seen overdue
  };
  [[nodiscard]] std::string consequence() const;

  LogSink& sink_;
  std::optional<Nanoseconds> watchdog_timeout_;
  std::map<std::string, Thread> threads_;  // those that have ever been overdue
};

}  // namespace hulltrack
