// The service's life: start, signals, reload, supervision, and what the outside is told.
//
// Runs in the main thread, ten turns a second. SIGTERM and SIGINT end it with a last write of health 0,
// state 7; SIGHUP reads the files again in a thread of its own and swaps only when all of them are good.
// The watchdog is fed only while every thread makes progress.
// Failure: an exit code, after one line in the log. run() throws when there is nothing to run: the first
// session cannot start, or after a reload neither the new configuration nor the old one can (the PLC is
// told).
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "daemon/app/figures.hpp"
#include "daemon/app/mailbox.hpp"
#include "daemon/app/notifier.hpp"
#include "daemon/app/prepare.hpp"
#include "daemon/app/progress_log.hpp"
#include "daemon/app/session.hpp"
#include "daemon/app/signals.hpp"
#include "daemon/app/syslog_sink.hpp"

namespace hulltrack {

class Service {
 public:
  /// References must outlive this object. `config_file` is read again on SIGHUP.
  Service(std::filesystem::path config_file, Prepared prepared, Signals& signals, SyslogSink& log);

  /// Returns when the service has ended: the exit code.
  int run();

 private:
  void start_session(const Prepared& prepared);
  void turn(SteadyTime now);
  void begin_reload();
  void finish_reload();
  void swap_to(Prepared next);
  void fall_back(const std::string& refusal);
  PlcWrite say_farewell();
  void supervise(SteadyTime now);
  void report(SteadyTime now);

  std::filesystem::path config_file_;
  Prepared prepared_;
  Signals& signals_;
  SyslogSink& log_;
  Notifier notifier_;
  ProgressLog progress_log_{log_, Notifier::watchdog_timeout()};
  Mailbox<std::optional<std::string>> failure_;  // a thread's, once it has ended
  std::unique_ptr<Session> session_;
  RegisterMemory registers_;  // of the session before
  std::future<Preparation> reload_;
  bool reload_again_ = false;
  bool stopping_ = false;
  Figures minute_;
  SteadyTime second_began_{};
  SteadyTime minute_began_{};
};

}  // namespace hulltrack
