// The service's life: start, signals, reload, supervision, and what the outside is told.
//
// Runs in the main thread, ten turns a second, and never waits for a file: those are read by a process of
// their own (preparer.hpp). At the start the PLC is told first: health 0 as soon as [plc] is known, and so on
// until the first session takes over. SIGTERM and SIGINT end it at any time, with a last write of health 0,
// state 7; SIGHUP, or somebody at the reload desk, has the files read again; they are in force only when all
// of them are good.
// After failures in a row it waits before it tries again (restart_record.hpp); SIGHUP ends the wait.
// The watchdog is fed only while every thread makes progress.
// Failure: an exit code, after one line in the log. run() throws when there is nothing to run: the first
// session cannot start, or after a reload neither the new configuration nor the old one can (the PLC is
// told).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/log/syslog_sink.hpp"
#include "daemon/service/figures.hpp"
#include "daemon/service/notifier.hpp"
#include "daemon/service/plc_stand_in.hpp"
#include "daemon/service/preparer.hpp"
#include "daemon/service/progress_log.hpp"
#include "daemon/service/reload_desk.hpp"
#include "daemon/service/restart_record.hpp"
#include "daemon/service/session.hpp"
#include "daemon/service/signals.hpp"
#include "daemon/threads/mailbox.hpp"

namespace hulltrack {

inline constexpr int kExitStopped = 0;
inline constexpr int kExitFailed = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitConfig = 78;  // EX_CONFIG of sysexits.h; RestartPreventExitStatus= of the unit

struct ServiceSetup {
  std::filesystem::path config_file;  // read again on SIGHUP
  ReaderSetup reader = {};
  std::optional<std::filesystem::path> runtime_folder = {};  // RuntimeDirectory= of the unit; none by hand
};

class Service {
 public:
  /// References must outlive this object.
  Service(ServiceSetup setup, Signals& signals, SyslogSink& log);

  /// Returns when the service has ended: the exit code.
  int run();

  /// After an end before the first session: what is wrong with the files.
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::optional<int> start();
  std::optional<int> wait_after_failures(const RestartRecord::Verdict& before);
  void read_files(bool beside_session);
  std::optional<int> turn_without_session();
  void meet_plc();
  void hand_over_registers();
  int give_up(const Preparation& preparation);
  void start_first_session(Prepared prepared);
  void start_session(const Prepared& prepared);

  void wait() const;
  void take_signals();
  void turn(SteadyTime now);
  int end(const std::string& why, int code);
  PlcWrite say_farewell();

  void begin_reload();
  void finish_reload();
  void refuse_reload(const std::vector<Problem>& problems);
  void tell_of_reload(bool reloaded, const std::string& text);
  void swap_to(Prepared next);
  void fall_back(const std::string& refusal);

  void open_desk();
  void supervise(SteadyTime now);
  void report(SteadyTime now);
  [[nodiscard]] GuardedThread::OnFailure on_failure();

  ServiceSetup setup_;
  Signals& signals_;
  SyslogSink& log_;
  Notifier notifier_;
  ProgressLog progress_log_{log_, Notifier::watchdog_timeout()};
  Mailbox<std::optional<std::string>> failure_;  // a thread's, once it has ended
  std::optional<Preparer> preparer_;             // while files are read, at the start or for a reload
  bool met_ = false;                             // [plc] of what preparer_ reads is known and taken
  std::vector<Problem> problems_;

  // Who talks to the PLC: the session, before the first one the stand-in, between two of them nobody.
  std::optional<PlcConfig> plc_;  // once it is known to be the one that is meant
  std::unique_ptr<PlcStandIn> stand_in_;
  std::unique_ptr<Session> session_;
  RegisterMemory registers_;  // of whoever talked before
  Prepared prepared_;         // the session's

  RestartRecord restarts_;
  std::optional<ReloadDesk> desk_;  // once a session runs
  bool waiting_ = false;            // after failures, before the next try
  bool reload_asked_ = false;       // by a signal, and not begun yet
  bool stopping_ = false;
  Figures minute_;
  SteadyTime session_began_{};  // the first one
  bool good_spell_told_ = false;
  SteadyTime second_began_{};
  SteadyTime minute_began_{};
};

}  // namespace hulltrack
