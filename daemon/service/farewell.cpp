#include "daemon/service/farewell.hpp"

#include "daemon/pipeline/live_time.hpp"

namespace hulltrack {
namespace {

/// A first attempt that took longer leaves no time for a second one.
constexpr Nanoseconds kPatience = std::chrono::seconds(1);

}  // namespace

PlcWrite write_farewell(PlcClient& client, WriteBlock block) {
  block.health = false;
  block.state = State::stopped;
  const SteadyTime began = steady_now();
  client.end_back_off();
  const PlcWrite first = client.write(block);
  if (first.ok() || steady_now() - began > kPatience) {
    return first;
  }
  client.end_back_off();
  return client.write(block);
}

std::string farewell_words(const PlcWrite& farewell) {
  if (farewell.ok()) {
    return "the PLC sees health 0";
  }
  const std::string why = farewell.message.empty() ? outcome_name(farewell.outcome) : farewell.message;
  return "the PLC could not be told (" + why +
         "): its registers may still say health 1, and it has to notice by the heartbeat that stands still";
}

}  // namespace hulltrack
