// Capture files written byte by byte, independent of libpcap and of our writer.
#pragma once

#include <cstdint>
#include <string>

namespace hulltrack::test {

inline std::string be16(unsigned v) { return {static_cast<char>(v >> 8), static_cast<char>(v)}; }
inline std::string be32(std::uint32_t v) { return be16(v >> 16) + be16(v & 0xFFFF); }
inline std::string le16(unsigned v) { return {static_cast<char>(v), static_cast<char>(v >> 8)}; }
inline std::string le32(std::uint32_t v) { return le16(v & 0xFFFF) + le16(v >> 16); }

inline std::string udp(unsigned source, unsigned destination, const std::string& payload) {
  return be16(source) + be16(destination) + be16(static_cast<unsigned>(payload.size() + 8)) + be16(0) +
         payload;
}

struct IpOptions {
  unsigned identification = 7;
  std::size_t offset = 0;  // bytes, a multiple of 8
  bool more = false;
  std::uint32_t source = 0xC0A801C9;  // 192.168.1.201
  unsigned protocol = 17;
  std::string options = {};  // of the header, a multiple of 4 bytes
};

inline std::string ipv4(const std::string& payload, const IpOptions& o = {}) {
  const auto header = static_cast<unsigned>(20 + o.options.size());
  return std::string(1, static_cast<char>(0x40 | header / 4)) + '\0' +
         be16(static_cast<unsigned>(header + payload.size())) + be16(o.identification) +
         be16(static_cast<unsigned>(o.offset / 8) | (o.more ? 0x2000U : 0U)) + '\x40' +
         static_cast<char>(o.protocol) + be16(0) + be32(o.source) + be32(0xC0A80164) + o.options + payload;
}

inline std::string ethernet(const std::string& payload, unsigned type = 0x0800) {
  return std::string(12, '\x02') + be16(type) + payload;
}
inline std::string vlan_tag(unsigned inner_type) { return be16(5) + be16(inner_type); }
inline std::string cooked(const std::string& payload) {
  return std::string(14, '\0') + be16(0x0800) + payload;
}
inline std::string cooked2(const std::string& payload) {
  return be16(0x0800) + std::string(18, '\0') + payload;
}

/// Classic capture, microseconds, little endian.
inline std::string pcap_header(std::uint32_t link_type, std::uint32_t magic = 0xA1B2C3D4) {
  return le32(magic) + le16(2) + le16(4) + le32(0) + le32(0) + le32(262144) + le32(link_type);
}
inline std::string pcap_record(const std::string& frame, std::uint32_t seconds = 100,
                               std::uint32_t fraction = 5, std::size_t cut = 0) {
  const auto length = static_cast<std::uint32_t>(frame.size());
  const auto captured = static_cast<std::uint32_t>(frame.size() - cut);
  return le32(seconds) + le32(fraction) + le32(captured) + le32(length) + frame.substr(0, captured);
}

/// pcapng with one interface; `nanoseconds` states its resolution as 10^-9, else the default of 10^-6.
inline std::string pcapng_header(std::uint32_t link_type, bool nanoseconds) {
  const std::string section = le32(0x1A2B3C4D) + le16(1) + le16(0) + le32(0xFFFFFFFF) + le32(0xFFFFFFFF);
  const std::string resolution = le16(9) + le16(1) + std::string("\x09\0\0\0", 4) + le32(0);
  const std::string interface =
      le16(link_type) + le16(0) + le32(0) + (nanoseconds ? resolution : std::string());
  const auto block = [](std::uint32_t type, const std::string& body) {
    const auto length = static_cast<std::uint32_t>(body.size() + 12);
    return le32(type) + le32(length) + body + le32(length);
  };
  return block(0x0A0D0D0A, section) + block(1, interface);
}
inline std::string pcapng_record(const std::string& frame, std::uint64_t ticks) {
  const auto size = static_cast<std::uint32_t>(frame.size());
  const std::string padded = frame + std::string((4 - frame.size() % 4) % 4, '\0');
  const std::string body = le32(0) + le32(static_cast<std::uint32_t>(ticks >> 32)) +
                           le32(static_cast<std::uint32_t>(ticks)) + le32(size) + le32(size) + padded;
  const auto length = static_cast<std::uint32_t>(body.size() + 12);
  return le32(6) + le32(length) + body + le32(length);
}

}  // namespace hulltrack::test
