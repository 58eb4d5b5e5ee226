// One configuration in force: its threads, what they share, and their orderly end.
//
// A reload ends one session and begins the next. Starts rx, track and plc when constructed; stops them in
// that order, so that the last write of the plc thread knows everything.
// Thread rule: owned by the main thread. Failure: the constructor throws std::runtime_error with one line
// (port in use ...), before anything runs; later failures of a thread are told to `on_failure`.
#pragma once

#include "daemon/service/exchange.hpp"
#include "daemon/service/plc_thread.hpp"
#include "daemon/service/preparer.hpp"
#include "daemon/service/rx_thread.hpp"
#include "daemon/service/track_thread.hpp"
#include "daemon/threads/guarded_thread.hpp"
#include "daemon/threads/thread_watch.hpp"

namespace hulltrack {

class Session {
 public:
  enum class Ending {
    for_good,    // the last write says health 0, state 7
    for_reload,  // the next session goes on writing
  };

  /// `before`: of the session before, whose registers this one goes on with.
  Session(const Prepared& prepared, LogSink& log, GuardedThread::OnFailure on_failure,
          const RegisterMemory& before = {});
  /// Ends for good unless end() was called before.
  ~Session();

  /// Stops the threads and gives what the registers said last.
  RegisterMemory end(Ending ending);
  /// How the last write of an end for good went.
  [[nodiscard]] const PlcWrite& farewell() const { return plc_.farewell(); }

  [[nodiscard]] const ThreadWatch& watch() const { return watch_; }
  [[nodiscard]] WriteBlock registers() const { return exchange_.registers.get(); }
  [[nodiscard]] Figures take_figures() { return exchange_.figures.take(); }

 private:
  Exchange exchange_;
  ThreadWatch watch_;
  RxThread rx_;
  TrackThread track_;
  PlcThread plc_;
  GuardedThread plc_runner_;
  GuardedThread track_runner_;
  GuardedThread rx_runner_;
};

}  // namespace hulltrack
