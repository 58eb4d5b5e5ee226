// One reading of the PLC, live or from a recording: its command word, then its joints.
//
// A reading that brings no news (the PLC's heartbeat stands still) changes neither: while the PLC's data is
// stale the last command stays in force. A re-acquire edge comes first, so that the gate believes the joints
// that come with it. Thread rule: the owner of latch and gate.
#pragma once

#include "daemon/pipeline/command_word.hpp"
#include "daemon/pipeline/joint_gate.hpp"

namespace hulltrack {

inline JointGate::Outcome take_plc_reading(const JointReading& reading, std::uint16_t command,
                                           CommandLatch& latch, JointGate& gate) {
  if (gate.is_news(reading) && latch.read(command)) {
    gate.reacquire();
  }
  return gate.offer(reading);
}

}  // namespace hulltrack
