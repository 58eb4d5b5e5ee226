// `udp_replay CAPTURE LOG FROM:TO...`: sends the datagrams of a capture to 127.0.0.1 in real time, those that
// went to port FROM to port TO; others are left out.
// Prints `first T`, the capture's stamp of the first one, and sends that at CLOCK_MONOTONIC = NS once
// standard input says `start NS`. LOG gets `capture_ns,sent_ns` a datagram: when it was captured (UTC), and
// when it really left (CLOCK_MONOTONIC).
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>
#include <thread>

#include "lidar_drivers/pcap_source.hpp"
#include "tests/support/free_port.hpp"

namespace hulltrack {
namespace {

std::chrono::nanoseconds now() { return std::chrono::steady_clock::now().time_since_epoch(); }

/// Waits for "start NS" on standard input.
std::chrono::nanoseconds read_start() {
  std::string word;
  std::int64_t ns = 0;
  std::cin >> word >> ns;
  return std::chrono::nanoseconds(ns);
}

using PortMap = std::map<std::uint16_t, std::uint16_t>;  // destination in the capture -> on this host

/// The next datagram to a port that is mapped.
Result<bool> next_mapped(PcapSource& source, const PortMap& ports, Datagram& datagram) {
  Result<bool> more = source.next(datagram);
  while (more && *more && !ports.contains(datagram.destination_port)) more = source.next(datagram);
  return more;
}

int replay(PcapSource& source, const PortMap& ports, std::FILE* log) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  Datagram datagram;
  Result<bool> more = next_mapped(source, ports, datagram);
  const MeasurementTime first = datagram.received;
  std::printf("first %lld\n", static_cast<long long>(to_ns(first)));
  std::fflush(stdout);
  const std::chrono::nanoseconds start = read_start();
  for (; more && *more; more = next_mapped(source, ports, datagram)) {
    sockaddr_in to = loopback_address(ports.at(datagram.destination_port));
    const std::chrono::nanoseconds due = start + (datagram.received - first);
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(due));
    static_cast<void>(
        sendto(fd, datagram.bytes.data(), datagram.bytes.size(), 0, as_sockaddr(&to), sizeof to));
    std::fprintf(log, "%lld,%lld\n", static_cast<long long>(to_ns(datagram.received)),
                 static_cast<long long>(now().count()));
  }
  close(fd);
  return more ? 0 : 1;
}

}  // namespace
}  // namespace hulltrack

int main(int argc, char** argv) {
  using namespace hulltrack;
  if (argc < 4) {
    std::fprintf(stderr, "usage: udp_replay CAPTURE LOG FROM:TO...\n");
    return 2;
  }
  PortMap ports;
  for (int i = 3; i < argc; ++i) {
    const std::string pair = argv[i];
    const std::size_t colon = pair.find(':');
    ports[static_cast<std::uint16_t>(std::stoi(pair))] =
        static_cast<std::uint16_t>(std::stoi(pair.substr(colon + 1)));
  }
  auto source = PcapSource::open(argv[1]);
  std::FILE* log = std::fopen(argv[2], "w");
  if (!source || log == nullptr) {
    std::fprintf(stderr, "udp_replay: %s\n",
                 source ? "cannot write the log" : source.error().message.c_str());
    return 1;
  }
  const int code = replay(*source, ports, log);
  std::fclose(log);
  return code;
}
