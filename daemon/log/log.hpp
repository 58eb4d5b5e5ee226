// Where log lines go: an interface, so that nothing below the daemon knows syslog.
//
// Algorithms never log; links and the daemon do, in plain words, one line an event.
// write() may be called from any thread and must not block.
#pragma once

#include <string_view>

namespace hulltrack {

/// Severities of syslog(3) that the service uses, least severe first.
enum class LogLevel { debug, info, notice, warning, error };

class LogSink {
 public:
  LogSink() = default;
  LogSink(const LogSink&) = delete;
  LogSink& operator=(const LogSink&) = delete;
  virtual ~LogSink() = default;
  /// One line, no newline in it.
  virtual void write(LogLevel level, std::string_view line) = 0;
};

}  // namespace hulltrack
