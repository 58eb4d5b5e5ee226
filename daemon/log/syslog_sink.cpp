#include "daemon/log/syslog_sink.hpp"

#include <syslog.h>
#include <unistd.h>

#include <string_view>

#include "daemon/threads/mailbox.hpp"

namespace hulltrack {
namespace {

/// syslog(3) keeps the pointer, and a queue's thread may still be in it while the process exits: the text
/// is never destroyed.
void open_syslog(const std::string& ident) {
  static std::string& kept_ident = *new std::string;
  kept_ident = ident;
  ::openlog(kept_ident.c_str(), LOG_PID | LOG_NDELAY, LOG_DAEMON);
}

void write_stderr(LogLevel level, std::string_view line) {
  std::string text(log_level_name(level));
  text.append(": ").append(line).push_back('\n');
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, rest.data(), rest.size());
    if (written <= 0) {
      return;  // nobody reads it
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

int syslog_facility(const std::string& name) {
  static constexpr int kLocal[] = {LOG_LOCAL0, LOG_LOCAL1, LOG_LOCAL2, LOG_LOCAL3,
                                   LOG_LOCAL4, LOG_LOCAL5, LOG_LOCAL6, LOG_LOCAL7};
  if (name.size() == 6 && name.starts_with("local") && name[5] >= '0' && name[5] <= '7') {
    return kLocal[name[5] - '0'];
  }
  return LOG_DAEMON;
}

int syslog_priority(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return LOG_DEBUG;
    case LogLevel::info:
      return LOG_INFO;
    case LogLevel::notice:
      return LOG_NOTICE;
    case LogLevel::warning:
      return LOG_WARNING;
    case LogLevel::error:
      return LOG_ERR;
  }
  return LOG_ERR;
}

struct SyslogSink::Shared {
  std::atomic<int> facility = LOG_DAEMON;
  Mailbox<std::string> ident;
};

SyslogSink::SyslogSink(const LogConfig& config, bool copy_to_stderr)
    : shared_(std::make_shared<Shared>()),
      level_(config.level),
      to_syslog_([opened = false, shared = shared_](LogLevel level, std::string_view line) mutable {
        if (!opened) {
          open_syslog(shared->ident.get());  // connects: can block, so not in the constructor
          opened = true;
        }
        ::syslog(syslog_priority(level) | shared->facility, "%.*s", static_cast<int>(line.size()),
                 line.data());
      }) {
  apply(config);
  if (copy_to_stderr) {
    to_stderr_ = std::make_unique<QueuedLog>(write_stderr);
  }
}

void SyslogSink::write(LogLevel level, std::string_view line) {
  if (level < level_) {
    return;
  }
  to_syslog_.write(level, line);
  if (to_stderr_) {
    to_stderr_->write(level, line);
  }
}

void SyslogSink::apply(const LogConfig& config) {
  level_ = config.level;
  shared_->facility = syslog_facility(config.facility);
  shared_->ident.put(config.ident);
}

void SyslogSink::flush() {
  to_syslog_.flush();
  if (to_stderr_) {
    to_stderr_->flush();
  }
}

}  // namespace hulltrack
