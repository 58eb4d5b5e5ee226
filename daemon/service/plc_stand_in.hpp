// Keeps the PLC informed while there is no session: health 0 and a living heartbeat.
//
// From the start on, as soon as [plc] is known: what the registers still say of a service that died must not
// stand while files are read. Also while the service waits before it tries again, and it says the last word
// of a service that cannot start. It is the plc thread with nobody beside it, so command word, state 6 and
// the rest are as in a session, which goes on from hand_over(). Thread rule: owned by the main thread.
// Failure: as a thread of a session, told to `on_failure`.
#pragma once

#include "daemon/service/exchange.hpp"
#include "daemon/service/plc_thread.hpp"
#include "daemon/threads/guarded_thread.hpp"
#include "daemon/threads/thread_watch.hpp"

namespace hulltrack {

class PlcStandIn {
 public:
  enum class Meaning {
    starting,  // state 0
    waiting,   // state 5: the service has failed and does not try yet
  };

  /// Writes at once. `log` must outlive this object. `before`: what the registers said last, if known.
  PlcStandIn(const PlcConfig& plc, Meaning meaning, LogSink& log, GuardedThread::OnFailure on_failure,
             const RegisterMemory& before = {});

  /// Stops without a last write: somebody else goes on from what this returns.
  RegisterMemory hand_over();
  /// Stops with health 0, state 7, and says how that went.
  PlcWrite say_farewell();

  [[nodiscard]] const ThreadWatch& watch() const { return watch_; }

 private:
  Exchange exchange_;
  ThreadWatch watch_;
  PlcThread plc_;
  GuardedThread runner_;
};

}  // namespace hulltrack
