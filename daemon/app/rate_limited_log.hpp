// Repeats of an event in the log: the first line at once, then at most one in ten seconds with a count.
//
// An event is named by a key ("lidar boom foreign sender"); its lines may differ in their figures.
// Pure logic over an injected time. Bounded: beyond kMaxKeys keys the new ones share one.
// Thread rule: one owner.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "core/base/log.hpp"
#include "core/base/time.hpp"

namespace hulltrack {

class RateLimitedLog {
 public:
  static constexpr std::size_t kMaxKeys = 64;

  /// `sink` must outlive this object.
  explicit RateLimitedLog(LogSink& sink, Nanoseconds interval = std::chrono::seconds(10))
      : sink_(sink), interval_(interval) {}

  /// Logs the line, or keeps it back and counts it.
  void write(LogLevel level, std::string_view key, std::string_view line, SteadyTime now);
  /// Logs what was kept back and is due, so that the last repeats of an event are told too. Call it
  /// about once a second.
  void flush(SteadyTime now);

 private:
  struct Event {
    SteadyTime logged;     // last line
    std::size_t held = 0;  // kept back since
    LogLevel level = LogLevel::info;
    std::string line;  // the newest kept back
  };
  void log(Event& event, SteadyTime now);

  LogSink& sink_;
  Nanoseconds interval_;
  std::map<std::string, Event, std::less<>> events_;
};

}  // namespace hulltrack
