// `udp_replay CAPTURE FROM_PORT TO_PORT LOG`: sends the datagrams of a capture to 127.0.0.1 in real time.
// Prints `first T`, the capture's stamp of the first one, and sends that at CLOCK_MONOTONIC = NS once
// standard input says `start NS`. LOG gets `capture_ns,sent_ns` a datagram: when it was captured (UTC), and
// when it really left (CLOCK_MONOTONIC).
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
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

int replay(PcapSource& source, std::uint16_t to_port, std::FILE* log) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to = loopback_address(to_port);
  Datagram datagram;
  Result<bool> more = source.next(datagram);
  const MeasurementTime first = datagram.received;
  std::printf("first %lld\n", static_cast<long long>(to_ns(first)));
  std::fflush(stdout);
  const std::chrono::nanoseconds start = read_start();
  for (; more && *more; more = source.next(datagram)) {
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
  if (argc != 5) {
    std::fprintf(stderr, "usage: udp_replay CAPTURE FROM_PORT TO_PORT LOG\n");
    return 2;
  }
  auto source = PcapSource::open(argv[1], {static_cast<std::uint16_t>(std::atoi(argv[2])), std::nullopt});
  std::FILE* log = std::fopen(argv[4], "w");
  if (!source || log == nullptr) {
    std::fprintf(stderr, "udp_replay: %s\n",
                 source ? "cannot write the log" : source.error().message.c_str());
    return 1;
  }
  const int code = replay(*source, static_cast<std::uint16_t>(std::atoi(argv[3])), log);
  std::fclose(log);
  return code;
}
