// A simulated PLC and a client of it, whose back-off runs on a clock that only the test moves.
#pragma once

#include <chrono>

#include "plc/plc_client.hpp"
#include "plc/sim/plc_server.hpp"

namespace hulltrack {

using namespace std::chrono_literals;

// Long enough for a slow machine where a reply is expected; short where a test has to wait it out.
inline constexpr Nanoseconds kPatient = 20s;
inline constexpr Nanoseconds kImpatient = 500ms;

struct TestClock {
  SteadyTime now = SteadyTime(1h);
  void advance(Nanoseconds step) { now += step; }
};

inline PlcConfig client_config(const sim::PlcServer& server, Nanoseconds response_timeout = kPatient) {
  PlcConfig config;
  config.host = "127.0.0.1";
  config.port = server.port();
  config.response_timeout = response_timeout;
  return config;
}

inline ModbusLink::Clock clock_of(const TestClock& clock) {
  return [&clock] { return clock.now; };
}

/// Polls, 20 ms of the test's clock apart, until one is ok.
struct Recovery {
  int lost = 0;  // polls that were not
  PlcPoll poll;  // the last one; not ok when it was given up
};

inline Recovery poll_until_ok(PlcClient& client, TestClock& clock, int most = 1000) {
  Recovery recovery;
  while (!(recovery.poll = client.poll()).ok() && ++recovery.lost < most) clock.advance(20ms);
  return recovery;
}

inline int polls_lost(PlcClient& client, TestClock& clock) { return poll_until_ok(client, clock).lost; }

}  // namespace hulltrack
