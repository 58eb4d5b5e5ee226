#include "lidar_drivers/pcap_writer.hpp"

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "lidar_drivers/bytes.hpp"

namespace hulltrack {

namespace {

constexpr std::uint32_t kMagicNanoseconds = 0xA1B23C4D;
constexpr std::uint32_t kLinkEthernet = 1;
constexpr std::uint32_t kSnapLength = 65'535 + 14;
constexpr std::size_t kRecordBytes = 16;
constexpr std::size_t kEthernetBytes = 14;
constexpr std::size_t kIpBytes = 20;
constexpr std::size_t kUdpBytes = 8;
constexpr std::size_t kHeaderBytes = kRecordBytes + kEthernetBytes + kIpBytes + kUdpBytes;
constexpr std::size_t kMaxPayload = 65'535 - kIpBytes - kUdpBytes;
constexpr std::uint8_t kUdpProtocol = 17;

/// RFC 1071, over a header with an even number of bytes.
std::uint16_t internet_checksum(Bytes header) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i + 1 < header.size(); i += 2) sum += read_be16(header, i);
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

/// Locally administered MAC address made of the IPv4 address.
void write_mac(std::span<std::uint8_t> mac, std::uint32_t ip) {
  write_be16(mac, 0, 0x0200);
  write_be32(mac, 2, ip);
}

void write_headers(std::span<std::uint8_t> frame, const UdpEndpoints& endpoints, std::size_t payload) {
  write_mac(frame.subspan(0), endpoints.destination_ip);
  write_mac(frame.subspan(6), endpoints.source_ip);
  write_be16(frame, 12, 0x0800);
  const auto ip = frame.subspan(kEthernetBytes, kIpBytes);
  ip[0] = 0x45;
  write_be16(ip, 2, static_cast<std::uint16_t>(kIpBytes + kUdpBytes + payload));
  write_be16(ip, 6, 0x4000);  // do not fragment
  ip[8] = 64;
  ip[9] = kUdpProtocol;
  write_be32(ip, 12, endpoints.source_ip);
  write_be32(ip, 16, endpoints.destination_ip);
  write_be16(ip, 10, internet_checksum(ip));
  const auto udp = frame.subspan(kEthernetBytes + kIpBytes, kUdpBytes);  // checksum 0 = none (RFC 768)
  write_be16(udp, 0, endpoints.source_port);
  write_be16(udp, 2, endpoints.destination_port);
  write_be16(udp, 4, static_cast<std::uint16_t>(kUdpBytes + payload));
}

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

Result<PcapWriter> PcapWriter::create(const std::filesystem::path& path) {
  std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "wb"));
  if (!file) return Error{path.string() + ": cannot be written: " + reason(errno)};
  std::array<std::uint8_t, 24> header{};
  write_le32(header, 0, kMagicNanoseconds);
  write_le16(header, 4, 2);  // version 2.4
  write_le16(header, 6, 4);
  write_le32(header, 16, kSnapLength);
  write_le32(header, 20, kLinkEthernet);
  PcapWriter writer(std::move(file), path);
  if (std::fwrite(header.data(), header.size(), 1, writer.file_.get()) != 1) return writer.failure();
  return writer;
}

Result<void> PcapWriter::write(MeasurementTime stamp, const UdpEndpoints& endpoints,
                               std::span<const std::uint8_t> payload) {
  if (!file_ || std::ferror(file_.get()) != 0) return failure();
  if (payload.size() > kMaxPayload) {
    return Error{path_.string() + ": a datagram of " + std::to_string(payload.size()) +
                 " bytes does not fit UDP; the limit is " + std::to_string(kMaxPayload)};
  }
  const std::int64_t seconds = to_ns(stamp) / 1'000'000'000;
  if (to_ns(stamp) < 0 || seconds > 0xFFFFFFFF) {
    return Error{path_.string() + ": a capture cannot hold the time " + std::to_string(to_ns(stamp)) +
                 " ns; allowed is 1970 to 2106"};
  }
  const auto length = static_cast<std::uint32_t>(kHeaderBytes - kRecordBytes + payload.size());
  std::array<std::uint8_t, kHeaderBytes> header{};
  write_le32(header, 0, static_cast<std::uint32_t>(seconds));
  write_le32(header, 4, static_cast<std::uint32_t>(to_ns(stamp) % 1'000'000'000));
  write_le32(header, 8, length);
  write_le32(header, 12, length);
  write_headers(std::span(header).subspan(kRecordBytes), endpoints, payload.size());
  if (std::fwrite(header.data(), header.size(), 1, file_.get()) != 1) return failure();
  if (!payload.empty() && std::fwrite(payload.data(), payload.size(), 1, file_.get()) != 1) return failure();
  return {};
}

Result<void> PcapWriter::close() {
  if (!file_) return {};
  const bool earlier_failure = std::ferror(file_.get()) != 0;
  const bool closed = std::fclose(file_.release()) == 0;
  if (earlier_failure || !closed) return failure();
  return {};
}

Error PcapWriter::failure() {
  if (error_ == 0) error_ = errno;
  return Error{path_.string() + ": writing failed: " + reason(error_) +
               "; free some space or choose another folder"};
}

}  // namespace hulltrack
