#include "daemon/service/notifier.hpp"

#include <systemd/sd-daemon.h>

#include <chrono>

namespace hulltrack {
namespace {

constexpr Nanoseconds kStartPeriod = std::chrono::seconds(1);

/// CLOCK_MONOTONIC in microseconds, as Type=notify-reload wants it beside RELOADING=1.
std::string monotonic_usec() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

}  // namespace

void Notifier::starting(SteadyTime now) {
  if (!last_start_ || now - *last_start_ >= kStartPeriod) {
    sd_notify(0, "EXTEND_TIMEOUT_USEC=10000000");
    last_start_ = now;
  }
}

void Notifier::ready() { sd_notify(0, "READY=1"); }

void Notifier::status(const std::string& line) {
  if (line != last_status_) {
    sd_notify(0, ("STATUS=" + line).c_str());
    last_status_ = line;
  }
}

void Notifier::watchdog(SteadyTime now) {
  if (watchdog_timeout_ && (!last_watchdog_ || now - *last_watchdog_ >= *watchdog_timeout_ / 3)) {
    sd_notify(0, "WATCHDOG=1");
    last_watchdog_ = now;
  }
}

void Notifier::reloading() { sd_notify(0, ("RELOADING=1\nMONOTONIC_USEC=" + monotonic_usec()).c_str()); }

void Notifier::stopping() { sd_notify(0, "STOPPING=1\nSTATUS=stopping"); }

std::optional<Nanoseconds> Notifier::watchdog_timeout() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) <= 0) {
    return std::nullopt;
  }
  return std::chrono::microseconds(microseconds);
}

}  // namespace hulltrack
