// The sensor's clock in a datagram's tail: a date, UTC, and microseconds.
//
// A sensor that was never told the time shows any date. One that is none counts as 1970-01-01, so that the
// clock still runs evenly, which is what telling lost datagrams needs; as a time it is refused further up,
// being far from the host's. The maker's SDK 2.0 differs from the manuals: it reads a year below 100 as since
// 2000 whatever the model, and a year 0 as four bytes of seconds since 1970. Neither is followed; a unit that
// sends such dates is years off here, so that the time of reception is used. Thread rule: pure functions.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/time.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/hesai/hesai_format.hpp"

namespace hulltrack::hesai {

/// Since 1970. Precondition: the datagram is as long as the model's.
[[nodiscard]] Nanoseconds read_clock(Bytes datagram, const ModelTable& model);

/// The inverse, to the microsecond begun. A date before the model's first year is written as none.
/// Precondition: a date in the years 1900 to 2155.
void write_clock(std::span<std::uint8_t> datagram, const ModelTable& model, Nanoseconds since_1970);

}  // namespace hulltrack::hesai
