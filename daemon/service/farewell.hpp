// The last write of a service that ends: health 0, state stopped.
//
// The registers may hold health 1 until it succeeds, and nobody is left who could try later. So it is tried
// twice, without back-off; what then remains is the PLC's own watch on the heartbeat, and the log says so.
// Thread rule: the client's owner. Cost: at most four response timeouts, and no second attempt when the
// first has taken a second: the service manager does not wait for ever (TimeoutStopSec= of the unit).
// Failure: the outcome of the last attempt.
#pragma once

#include <string>

#include "plc/plc_client.hpp"

namespace hulltrack {

/// `block`: what stands beside health 0 and state stopped.
[[nodiscard]] PlcWrite write_farewell(PlcClient& client, WriteBlock block);

/// What the PLC knows after it, for the log: a clause.
[[nodiscard]] std::string farewell_words(const PlcWrite& farewell);

}  // namespace hulltrack
