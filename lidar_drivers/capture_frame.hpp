// One captured link-layer frame -> the IPv4 packet in it.
//
// Ethernet, Linux cooked v1 and v2, raw IP; VLAN tags skipped however deep. `captured` may be shorter than
// what was on the wire (`wire_length`): then the answer is `truncated`, never a read past the end. Thread
// rule: pure function. Cost: some dozen instructions.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lidar_drivers/bytes.hpp"

namespace hulltrack {

enum class LinkType { ethernet, linux_cooked, linux_cooked2, raw_ip };

struct Ipv4Packet {
  std::uint32_t source = 0;  // host byte order
  std::uint32_t destination = 0;
  std::uint16_t identification = 0;
  std::uint8_t protocol = 0;
  bool more_fragments = false;
  std::size_t fragment_offset = 0;  // bytes
  Bytes payload;

  [[nodiscard]] bool is_fragment() const { return more_fragments || fragment_offset != 0; }
};

enum class FrameContent {
  ipv4,
  other,      // another protocol
  truncated,  // captured with fewer bytes than were sent
  malformed,  // headers that contradict themselves
};

/// Fills `out` when the answer is ipv4.
[[nodiscard]] FrameContent read_ipv4(LinkType link, Bytes captured, std::size_t wire_length, Ipv4Packet& out);

}  // namespace hulltrack
