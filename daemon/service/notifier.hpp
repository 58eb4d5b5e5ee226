// What the service manager is told: sd_notify(3), in the service's words.
//
// Without a manager (no NOTIFY_SOCKET) every call does nothing, and no failure is reported: a manager that
// is not there is no reason to stop tracking. One that is there but does not read may hold a call up, so
// only the main thread calls, which no pose waits for.
#pragma once

#include <optional>
#include <string>

#include "core/base/time.hpp"

namespace hulltrack {

class Notifier {
 public:
  /// The start makes progress: TimeoutStartSec= of the unit is held off for as long as this is called once a
  /// second or more often.
  void starting(SteadyTime now);
  void ready();
  /// One line for `systemctl status`; sent only when it differs from the last.
  void status(const std::string& line);
  /// Everything makes progress; sent three times in WatchdogSec=, however often it is called.
  void watchdog(SteadyTime now);
  void reloading();
  void stopping();

  /// WatchdogSec=; nothing if no watchdog is set.
  [[nodiscard]] static std::optional<Nanoseconds> watchdog_timeout();

 private:
  std::optional<Nanoseconds> watchdog_timeout_ = watchdog_timeout();
  std::optional<SteadyTime> last_watchdog_;
  std::optional<SteadyTime> last_start_;
  std::string last_status_;
};

}  // namespace hulltrack
