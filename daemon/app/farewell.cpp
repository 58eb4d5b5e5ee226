#include "daemon/app/farewell.hpp"

#include "daemon/app/live_time.hpp"

namespace hulltrack {

PlcWrite write_farewell(const PlcConfig& plc, WriteBlock last, SteadyTime left_at, std::uint16_t heartbeat) {
  last.health = false;
  last.state = State::stopped;
  if (last.age_ms < kUnknownAgeMs) {
    last.age_ms += to_milliseconds(steady_now() - left_at);
  }
  PlcClient client(plc, {}, heartbeat);
  const PlcWrite first = client.write(last);
  return first.ok() ? first : client.write(last);  // a first error is tried again at once
}

}  // namespace hulltrack
