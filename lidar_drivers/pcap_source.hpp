// Datagrams of a capture file: classic pcap or pcapng, as any capture tool writes it.
//
// Link types Ethernet, Linux cooked v1 and v2, raw IP; VLAN tags (nested too); IPv4 with fragments put
// together again. What is broken is counted, never read past: a record cut by the capture's snap length
// yields no datagram, a file cut short ends with an error after its last whole record.
// Stamps are the capture's, UTC. Thread rule: one owner. Memory: bounded whatever the file says.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/base/result.hpp"
#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/capture_frame.hpp"
#include "lidar_drivers/datagram.hpp"
#include "lidar_drivers/ipv4_reassembly.hpp"

struct pcap;

namespace hulltrack {

struct PcapFilter {
  std::optional<std::uint16_t> port;       // destination
  std::optional<std::uint32_t> source_ip;  // host byte order
};

struct PcapCounters {
  std::uint64_t records = 0;            // in the file
  std::uint64_t datagrams = 0;          // handed out
  std::uint64_t filtered = 0;           // whole UDP datagrams that the filter refused
  std::uint64_t not_udp = 0;            // ARP, IPv6, TCP ...
  std::uint64_t truncated = 0;          // captured with fewer bytes than were sent
  std::uint64_t malformed = 0;          // headers that contradict themselves, stamps out of range
  std::uint64_t fragments = 0;          // IPv4 fragments seen
  std::uint64_t fragments_dropped = 0;  // of datagrams that overlapped or were never complete
  /// Datagrams per UDP destination port, the first 32 ports; for telling a user which port it is.
  std::map<std::uint16_t, std::uint64_t> ports;
};

class PcapSource {
 public:
  /// An error names the file and what is wrong: absent, not a capture, a link type that is not supported.
  [[nodiscard]] static Result<PcapSource> open(const std::filesystem::path& path,
                                               const PcapFilter& filter = {});
  /// The same on an open stream, which it takes over; `name` stands in messages.
  [[nodiscard]] static Result<PcapSource> open(std::FILE* stream, const std::string& name,
                                               const PcapFilter& filter = {});

  PcapSource(PcapSource&&) noexcept;
  PcapSource& operator=(PcapSource&&) noexcept;
  ~PcapSource();

  /// True: `out` is the next datagram, valid until the next call. False: the file's regular end. An error:
  /// the file is cut short or broken here; everything before it has been handed out.
  [[nodiscard]] Result<bool> next(Datagram& out);

  [[nodiscard]] const PcapCounters& counters() const { return counters_; }
  /// After the end, when nothing that was handed out was of use: why not, naming the ports that were seen.
  /// `wanted`, such as " for any LiDAR", says what was looked for beyond the filter.
  [[nodiscard]] std::string explain_nothing_found(const std::string& wanted = {}) const;

 private:
  struct Close {
    void operator()(::pcap* handle) const;
  };
  PcapSource(std::unique_ptr<::pcap, Close> handle, LinkType link_type, std::string name,
             const PcapFilter& filter);
  [[nodiscard]] bool read_record(Bytes captured, std::uint32_t length, WallTime stamp, Datagram& out);
  [[nodiscard]] bool read_udp(Bytes ip_payload, std::uint32_t source_ip, Datagram& out);

  std::unique_ptr<::pcap, Close> handle_;
  LinkType link_type_;
  std::string name_;
  PcapFilter filter_;
  PcapCounters counters_;
  Ipv4Reassembly reassembly_;
};

}  // namespace hulltrack
