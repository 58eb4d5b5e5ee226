#include "lidar_drivers/pcap_source.hpp"

#include <pcap/pcap.h>

#include <cerrno>
#include <system_error>

#include "lidar_drivers/capture_frame.hpp"
#include "lidar_drivers/datagram_router.hpp"

namespace hulltrack {

namespace {

constexpr std::size_t kUdpHeaderBytes = 8;
constexpr std::uint8_t kUdpProtocol = 17;
constexpr std::size_t kPortsListed = 32;
constexpr std::int64_t kLastSecond = 0xFFFFFFFF;  // 2106, the end of classic captures

std::optional<LinkType> link_type_of(int dlt) {
  switch (dlt) {
    case DLT_EN10MB:
      return LinkType::ethernet;
    case DLT_LINUX_SLL:
      return LinkType::linux_cooked;
    case DLT_LINUX_SLL2:
      return LinkType::linux_cooked2;
    case DLT_RAW:
    case DLT_IPV4:
      return LinkType::raw_ip;
    default:
      return std::nullopt;
  }
}

}  // namespace

void PcapSource::Close::operator()(::pcap* handle) const { pcap_close(handle); }

Result<PcapSource> PcapSource::open(const std::filesystem::path& path, const PcapFilter& filter) {
  std::FILE* stream = std::fopen(path.c_str(), "rb");
  if (stream == nullptr) {
    return Error{path.string() + ": cannot be opened: " + std::generic_category().message(errno)};
  }
  return open(stream, path.string(), filter);
}

Result<PcapSource> PcapSource::open(std::FILE* stream, const std::string& name, const PcapFilter& filter) {
  char reason[PCAP_ERRBUF_SIZE] = "";
  std::unique_ptr<::pcap, Close> handle(
      pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, reason));
  if (!handle) {
    std::fclose(stream);
    return Error{name + ": not a capture (" + reason + "); expected a pcap or pcapng file"};
  }
  const int dlt = pcap_datalink(handle.get());
  const auto link = link_type_of(dlt);
  if (!link) {
    const char* known = pcap_datalink_val_to_name(dlt);
    return Error{name + ": captured on link type " + (known != nullptr ? known : std::to_string(dlt)) +
                 "; expected Ethernet, Linux cooked or raw IP, so capture on the network interface itself"};
  }
  return PcapSource(std::move(handle), *link, name, filter);
}

PcapSource::PcapSource(std::unique_ptr<::pcap, Close> handle, LinkType link_type, std::string name,
                       const PcapFilter& filter)
    : handle_(std::move(handle)), link_type_(link_type), name_(std::move(name)), filter_(filter) {}

PcapSource::PcapSource(PcapSource&&) noexcept = default;
PcapSource& PcapSource::operator=(PcapSource&&) noexcept = default;
PcapSource::~PcapSource() = default;

Result<bool> PcapSource::next(Datagram& out) {
  for (;;) {
    pcap_pkthdr* header = nullptr;
    const u_char* data = nullptr;
    const int status = pcap_next_ex(handle_.get(), &header, &data);
    counters_.fragments_dropped = reassembly_.dropped() + (status == 1 ? 0 : reassembly_.pending());
    if (status == PCAP_ERROR_BREAK) return false;
    if (status != 1) {
      return Error{name_ + ": broken after record " + std::to_string(counters_.records) + " (" +
                   pcap_geterr(handle_.get()) + "); what comes before it can be used, the rest is missing"};
    }
    ++counters_.records;
    const std::int64_t seconds = header->ts.tv_sec;
    const std::int64_t fraction = header->ts.tv_usec;  // nanoseconds, as asked for in open()
    if (seconds < 0 || seconds > kLastSecond || fraction < 0 || fraction >= 1'000'000'000) {
      ++counters_.malformed;
      continue;
    }
    const WallTime stamp{Nanoseconds(seconds * 1'000'000'000 + fraction)};
    if (read_record(Bytes(data, header->caplen), header->len, stamp, out)) {
      ++counters_.datagrams;
      return true;
    }
  }
}

bool PcapSource::read_record(Bytes captured, std::uint32_t length, WallTime stamp, Datagram& out) {
  Ipv4Packet packet;
  switch (read_ipv4(link_type_, captured, length, packet)) {
    case FrameContent::ipv4:
      break;
    case FrameContent::other:
      ++counters_.not_udp;
      return false;
    case FrameContent::truncated:
      ++counters_.truncated;
      return false;
    case FrameContent::malformed:
      ++counters_.malformed;
      return false;
  }
  if (packet.protocol != kUdpProtocol) {
    ++counters_.not_udp;
    return false;
  }
  if (packet.is_fragment()) {
    ++counters_.fragments;
    const FragmentKey key{packet.source, packet.destination, packet.identification, packet.protocol};
    const auto whole =
        reassembly_.add(key, packet.fragment_offset, packet.more_fragments, packet.payload, stamp);
    if (!whole) return false;
    packet.payload = *whole;
  }
  out.received = MeasurementTime{stamp.time_since_epoch()};
  out.received_utc = stamp;
  return read_udp(packet.payload, packet.source, out);
}

bool PcapSource::read_udp(Bytes ip_payload, std::uint32_t source_ip, Datagram& out) {
  if (ip_payload.size() < kUdpHeaderBytes) {
    ++counters_.malformed;
    return false;
  }
  const std::size_t length = read_be16(ip_payload, 4);
  if (length < kUdpHeaderBytes || length > ip_payload.size()) {
    ++counters_.malformed;
    return false;
  }
  out.source_ip = source_ip;
  out.source_port = read_be16(ip_payload, 0);
  out.destination_port = read_be16(ip_payload, 2);
  out.bytes = ip_payload.subspan(kUdpHeaderBytes, length - kUdpHeaderBytes);
  if (counters_.ports.size() < kPortsListed || counters_.ports.contains(out.destination_port)) {
    ++counters_.ports[out.destination_port];
  }
  const bool wanted = (!filter_.port || *filter_.port == out.destination_port) &&
                      (!filter_.source_ip || *filter_.source_ip == out.source_ip);
  if (!wanted) ++counters_.filtered;
  return wanted;
}

std::string PcapSource::explain_nothing_found(const std::string& wanted) const {
  std::string text = name_ + ": no datagrams" + wanted;
  if (filter_.port) text += " to UDP port " + std::to_string(*filter_.port);
  if (filter_.source_ip) text += " from " + format_ipv4(*filter_.source_ip);
  text += " among " + std::to_string(counters_.records) + " records";
  if (counters_.truncated > 0) {
    text += "; " + std::to_string(counters_.truncated) + " were captured cut off, so capture whole packets";
  }
  if (counters_.ports.empty()) return text + "; no UDP was seen at all";
  text += "; UDP ports seen:";
  const char* separator = " ";
  for (const auto& [port, count] : counters_.ports) {
    text += separator + std::to_string(port) + " (" + std::to_string(count) + ")";
    separator = ", ";
  }
  return text;
}

}  // namespace hulltrack
