#include "daemon/service/plc_stand_in.hpp"

#include <utility>

#include "daemon/pipeline/live_time.hpp"

namespace hulltrack {
namespace {

Config only(const PlcConfig& plc) {
  Config config;
  config.plc = plc;
  return config;
}

}  // namespace

PlcStandIn::PlcStandIn(const PlcConfig& plc, Meaning meaning, LogSink& log,
                       GuardedThread::OnFailure on_failure, const RegisterMemory& before)
    : plc_(only(plc), exchange_, watch_.add("plc", plc_turn_limit(plc), steady_now()), log, before),
      runner_(
          "plc",
          [this, meaning](std::stop_token stop) {
            exchange_.out_of_service = meaning == Meaning::waiting;
            plc_.run(stop);
          },
          std::move(on_failure), [this] { exchange_.plc_bell.ring(); }) {}

RegisterMemory PlcStandIn::hand_over() {
  plc_.leave_without_farewell();
  runner_.stop();
  return plc_.memory();
}

PlcWrite PlcStandIn::say_farewell() {
  runner_.stop();
  return plc_.farewell();
}

}  // namespace hulltrack
