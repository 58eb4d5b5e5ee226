// Kernel stamps (wall clock) to the clock of measurements (live: monotonic).
//
// The stamp's age is taken on the wall clock and subtracted from the monotonic now; a wall clock that was
// stepped in between cannot move a measurement by more than the bracket, 0 to 1 s.
// Pure: the caller reads both clocks, back to back, right after the datagram.
#pragma once

#include "core/base/time.hpp"

namespace hulltrack {

inline constexpr Nanoseconds kMaxReceiveDelay = std::chrono::seconds(1);

[[nodiscard]] MeasurementTime receive_time(WallTime stamp, WallTime realtime_now, SteadyTime monotonic_now);

}  // namespace hulltrack
