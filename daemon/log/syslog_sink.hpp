// The service's log: syslog(3), and on request a copy on standard error with the level's name.
//
// Never blocks (queued_log.hpp). Lines less severe than the configured level are left out.
// One at a time in a process, because syslog(3) keeps its ident globally. Thread rule: any thread.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "daemon/log/log.hpp"
#include "daemon/log/log_config.hpp"
#include "daemon/log/queued_log.hpp"

namespace hulltrack {

class SyslogSink final : public LogSink {
 public:
  SyslogSink(const LogConfig& config, bool copy_to_stderr);
  ~SyslogSink() override = default;

  void write(LogLevel level, std::string_view line) override;
  /// Takes over level and facility of a configuration, and the ident unless a line has been written: syslog
  /// keeps the first until a restart.
  void apply(const LogConfig& config);
  /// Waits until what has been written is out, for half a second at most.
  void flush();

 private:
  struct Shared;  // with the queue's thread, which can outlive this object
  std::shared_ptr<Shared> shared_;
  std::atomic<LogLevel> level_;
  QueuedLog to_syslog_;
  std::unique_ptr<QueuedLog> to_stderr_;
};

/// LOG_DAEMON, LOG_LOCAL0 ... for "daemon", "local0" .. "local7"; LOG_DAEMON for anything else.
[[nodiscard]] int syslog_facility(const std::string& name);
/// LOG_DEBUG .. LOG_ERR.
[[nodiscard]] int syslog_priority(LogLevel level);

}  // namespace hulltrack
