#include "daemon/service/session.hpp"

#include "daemon/pipeline/live_time.hpp"

namespace hulltrack {
Session::Session(const Prepared& prepared, LogSink& log, GuardedThread::OnFailure on_failure,
                 const RegisterMemory& before)
    : rx_(prepared.config, exchange_, watch_.add("rx", kTurnLimit, steady_now()), log),
      track_(prepared.config, prepared.map, prepared.quay, exchange_,
             watch_.add("track", kTurnLimit, steady_now())),
      plc_(prepared.config, exchange_, watch_.add("plc", plc_turn_limit(prepared.config.plc), steady_now()),
           log, before),
      plc_runner_(
          "plc", [this](std::stop_token stop) { plc_.run(stop); }, on_failure,
          [this] { exchange_.plc_bell.ring(); }),
      track_runner_(
          "track", [this](std::stop_token stop) { track_.run(stop); }, on_failure,
          [this] { exchange_.track_bell.ring(); }),
      rx_runner_(
          "rx", [this](std::stop_token stop) { rx_.run(stop); }, on_failure) {}

Session::~Session() { end(Ending::for_good); }

RegisterMemory Session::end(Ending ending) {
  rx_runner_.stop();
  track_runner_.stop();
  if (ending == Ending::for_reload) {
    plc_.leave_without_farewell();
  }
  plc_runner_.stop();
  return plc_.memory();
}

}  // namespace hulltrack
