#include "lidar_drivers/receive_clock.hpp"

#include <algorithm>

namespace hulltrack {

MeasurementTime receive_time(WallTime stamp, WallTime realtime_now, SteadyTime monotonic_now) {
  // Compared before subtracting: a stamp from a broken clock must not overflow the difference.
  const Nanoseconds age = stamp >= realtime_now ? Nanoseconds::zero()
                          : stamp.time_since_epoch() < realtime_now.time_since_epoch() - kMaxReceiveDelay
                              ? kMaxReceiveDelay
                              : realtime_now - stamp;
  return MeasurementTime{monotonic_now.time_since_epoch() - age};
}

}  // namespace hulltrack
