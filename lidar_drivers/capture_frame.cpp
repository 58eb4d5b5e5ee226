#include "lidar_drivers/capture_frame.hpp"

namespace hulltrack {

namespace {

constexpr std::uint16_t kEtherIpv4 = 0x0800;
constexpr std::size_t kVlanTagBytes = 4;
constexpr std::size_t kMinIpHeader = 20;

/// Where a link header keeps the protocol, and how long it is.
struct LinkHeader {
  std::size_t protocol_offset;
  std::size_t bytes;
};

LinkHeader link_header(LinkType link) {
  switch (link) {
    case LinkType::ethernet:
      return {12, 14};
    case LinkType::linux_cooked:
      return {14, 16};
    case LinkType::linux_cooked2:
      return {0, 20};
    case LinkType::raw_ip:
      break;
  }
  return {0, 0};
}

/// 802.1Q, 802.1ad and the older tag for stacked VLANs.
bool is_vlan(std::uint16_t protocol) {
  return protocol == 0x8100 || protocol == 0x88A8 || protocol == 0x9100;
}

}  // namespace

FrameContent read_ipv4(LinkType link, Bytes captured, std::size_t wire_length, Ipv4Packet& out) {
  const FrameContent too_short =
      captured.size() < wire_length ? FrameContent::truncated : FrameContent::malformed;
  Bytes rest = captured;
  if (link != LinkType::raw_ip) {
    const LinkHeader header = link_header(link);
    if (rest.size() < header.bytes) return too_short;
    std::uint16_t protocol = read_be16(rest, header.protocol_offset);
    rest = rest.subspan(header.bytes);
    while (is_vlan(protocol)) {
      if (rest.size() < kVlanTagBytes) return too_short;
      protocol = read_be16(rest, 2);
      rest = rest.subspan(kVlanTagBytes);
    }
    if (protocol != kEtherIpv4) return FrameContent::other;
  }

  if (rest.empty()) return too_short;
  if (rest[0] >> 4 != 4) return link == LinkType::raw_ip ? FrameContent::other : FrameContent::malformed;
  if (rest.size() < kMinIpHeader) return too_short;
  const std::size_t header = std::size_t{4} * (rest[0] & 0x0F);
  const std::size_t total = read_be16(rest, 2);
  if (header < kMinIpHeader || total < header) return FrameContent::malformed;
  if (rest.size() < total) return too_short;
  const std::uint16_t fragment = read_be16(rest, 6);
  out.identification = read_be16(rest, 4);
  out.more_fragments = (fragment & 0x2000) != 0;
  out.fragment_offset = std::size_t{8} * (fragment & 0x1FFF);
  out.protocol = rest[9];
  out.source = read_be32(rest, 12);
  out.destination = read_be32(rest, 16);
  out.payload = rest.subspan(header, total - header);  // what follows is the link's padding
  return FrameContent::ipv4;
}

}  // namespace hulltrack
