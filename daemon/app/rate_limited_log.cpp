#include "daemon/app/rate_limited_log.hpp"

namespace hulltrack {

void RateLimitedLog::write(LogLevel level, std::string_view key, std::string_view line, SteadyTime now) {
  auto found = events_.find(key);
  if (found == events_.end()) {
    static constexpr std::string_view kShared = "(other events)";
    const bool full = events_.size() >= kMaxKeys;
    found = full ? events_.find(kShared) : events_.end();
    if (found == events_.end()) {
      found = events_.emplace(full ? kShared : key, Event{}).first;
      found->second.logged = now - interval_;  // due at once
    }
  }
  Event& event = found->second;
  ++event.held;
  event.level = level;
  event.line = line;
  if (now - event.logged >= interval_) {
    log(event, now);
  }
}

void RateLimitedLog::flush(SteadyTime now) {
  for (auto entry = events_.begin(); entry != events_.end();) {
    Event& event = entry->second;
    const bool due = now - event.logged >= interval_;
    if (due && event.held == 0) {
      entry = events_.erase(entry);  // quiet for a whole interval: the next one is a first one again
      continue;
    }
    if (due) {
      log(event, now);
    }
    ++entry;
  }
}

void RateLimitedLog::log(Event& event, SteadyTime now) {
  std::string line = event.line;
  if (event.held > 1) {
    line += " (" + std::to_string(event.held) + " times in the last " +
            std::to_string(static_cast<long>(to_seconds(now - event.logged) + 0.5)) + " s)";
  }
  sink_.write(event.level, line);
  event.logged = now;
  event.held = 0;
}

}  // namespace hulltrack
