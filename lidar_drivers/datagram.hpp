// One UDP datagram with what the receiver knows about it: the currency of every source.
//
// `bytes` is borrowed: valid until the source is asked for more.
// `received` stands for the last firing in the datagram: a sensor sends as soon as it is complete.
// Thread rule: a plain value; do not keep it.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/time.hpp"

namespace hulltrack {

struct Datagram {
  std::span<const std::uint8_t> bytes;  // UDP payload
  MeasurementTime received{};           // live: kernel stamp on the monotonic clock; capture: its UTC stamp
  WallTime received_utc{};              // the same moment on the host's wall clock
  std::uint32_t source_ip = 0;          // host byte order
  std::uint16_t source_port = 0;
  std::uint16_t destination_port = 0;
};

}  // namespace hulltrack
