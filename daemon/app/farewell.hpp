// The last write of a service that has no plc thread any more: health 0, state stopped.
//
// For the one case in which a reload can end in nothing: neither the new nor the old configuration could be
// put in force. The registers still hold what the last session left, maybe health 1; that must not stand
// until the PLC's own timer notices. Thread rule: main thread. Cost: at most two response timeouts.
// Failure: the outcome of the write; nobody is left who could try again.
#pragma once

#include "core/base/time.hpp"
#include "plc/plc_client.hpp"

namespace hulltrack {

/// `last`: the registers as they were left at `left_at`; `heartbeat`: the last one written.
PlcWrite write_farewell(const PlcConfig& plc, WriteBlock last, SteadyTime left_at, std::uint16_t heartbeat);

}  // namespace hulltrack
