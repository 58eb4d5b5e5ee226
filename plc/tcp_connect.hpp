// A connected TCP socket within a time limit, fit for libmodbus.
//
// The socket is non-blocking, close-on-exec, without Nagle's delay, with keepalive. libmodbus waits with
// select(), so a descriptor of FD_SETSIZE or more is refused rather than written past an fd_set.
// Failure: a Result with the system's words. Thread rule: reentrant. Cost: at most `limit`.
#pragma once

#include "core/base/result.hpp"
#include "core/base/time.hpp"
#include "plc/host_resolver.hpp"

namespace hulltrack {

/// The descriptor; the caller closes it.
[[nodiscard]] Result<int> connect_within(const SocketAddress& address, Nanoseconds limit);

}  // namespace hulltrack
