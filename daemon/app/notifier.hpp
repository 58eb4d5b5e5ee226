// What the service manager is told: sd_notify(3), in the service's words.
//
// Without a manager (no NOTIFY_SOCKET) every call does nothing. Never blocks noticeably, never fails:
// a manager that does not listen is no reason to stop tracking. Thread rule: the main thread only.
#pragma once

#include <optional>
#include <string>

#include "core/base/time.hpp"

namespace hulltrack {

class Notifier {
 public:
  void ready();
  /// One line for `systemctl status`; sent only when it differs from the last.
  void status(const std::string& line);
  void watchdog();
  void reloading();
  void stopping();

  /// How often watchdog() must be called (a third of WatchdogSec=); nothing if no watchdog is set.
  [[nodiscard]] static std::optional<Nanoseconds> watchdog_period();

 private:
  std::string last_status_;
};

}  // namespace hulltrack
