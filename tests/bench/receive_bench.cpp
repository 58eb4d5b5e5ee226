// Is anything lost at twice the rate of each model? Datagrams over the loopback interface into sockets and
// scan builder, which run in a thread of their own as in the service.
//
// Prints for each the datagrams and bits a second, how many were sent and received, how many of the missing
// ones the kernel dropped for want of buffer and the sequence found missing, the share of one core that the
// receiving thread took, and how far the sender, who keeps an absolute schedule, fell behind it. Sockets are
// as the service sets them. Usage: bench_receive [SECONDS]   (a model, default 2)
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stop_token>
#include <thread>

#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "lidar_drivers/udp_source.hpp"
#include "tests/bench/sensor_streams.hpp"
#include "tests/bench/stopwatch.hpp"
#include "tests/support/free_port.hpp"

namespace hulltrack {
namespace {

constexpr int kFaster = 2;  // than the sensor sends
/// After the last datagram, for what still waits in the socket.
constexpr std::chrono::milliseconds kDrain{300};

/// The receiving path of the service: all that waits, in batches, to scans.
class Receiver {
 public:
  explicit Receiver(const LidarConfig& config)
      : sockets_(open_udp_sources({&config, 1}).value()),
        router_(DatagramRouter::create({&config, 1}).value()),
        builder_(ScanBuilder::create({config}, {}).value()) {}

  void run(const std::stop_token& stop) {
    std::vector<pollfd> ready;
    for (const UdpSource& socket : sockets_.sources) ready.push_back({socket.fd(), POLLIN, 0});
    bench::Stopwatch watch;
    while (!stop.stop_requested()) {
      if (poll(ready.data(), ready.size(), 20) <= 0) continue;
      for (UdpSource& socket : sockets_.sources) drain(socket);
    }
    cpu_ = 1e-3 * watch.lap().cpu;
  }

  [[nodiscard]] const UdpCounters& counters() const {
    return sockets_.sources[sockets_.data_of[0]].counters();
  }
  [[nodiscard]] LidarStatus status() const { return builder_.status(0); }
  [[nodiscard]] double cpu() const { return cpu_; }  // s
  [[nodiscard]] const std::vector<std::string>& warnings() const { return sockets_.sources[0].warnings(); }

 private:
  void drain(UdpSource& socket) {
    for (;;) {
      const auto datagrams = socket.receive().value();
      if (datagrams.empty()) return;
      for (const Datagram& datagram : datagrams) {
        if (const auto lidar = router_.lidar_of(datagram)) builder_.add(*lidar, datagram);
        while (builder_.take(scan_)) {
        }
      }
    }
  }

  UdpSources sockets_;
  DatagramRouter router_;
  ScanBuilder builder_;
  Scan scan_;
  double cpu_ = 0.0;
};

struct Sending {
  std::uint64_t datagrams = 0;
  std::uint64_t bytes = 0;
  Nanoseconds latest{};  // behind the schedule
};

void send(int fd, const std::vector<std::uint8_t>& bytes, std::uint16_t port) {
  sockaddr_in to = loopback_address(port);
  if (sendto(fd, bytes.data(), bytes.size(), 0, as_sockaddr(&to), sizeof to) < 0) {
    std::perror("bench_receive: send");
    std::exit(1);
  }
}

/// The stream again and again, each datagram when it is due or, if that was missed, at once.
Sending send_stream(const bench::SensorStream& stream, const LidarConfig& config, int seconds) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  Sending done;
  if (!stream.information.empty()) send(fd, stream.information, config.information_port);
  const auto start = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
  for (int round = 0; round < seconds * kFaster; ++round) {
    for (std::size_t i = 0; i < stream.datagrams.size(); ++i) {
      const auto due = start + (round * bench::kStreamLength + stream.sent[i]) / kFaster;
      std::this_thread::sleep_until(due);
      done.latest = std::max<Nanoseconds>(done.latest, std::chrono::steady_clock::now() - due);
      send(fd, stream.datagrams[i], config.port);
      ++done.datagrams;
      done.bytes += stream.datagrams[i].size();
    }
  }
  close(fd);
  return done;
}

void measure(const bench::SensorStream& stream, int seconds) {
  LidarConfig config = stream.config;
  config.bind = "127.0.0.1";
  config.port = free_port(SOCK_DGRAM);
  if (!stream.information.empty()) config.information_port = free_port(SOCK_DGRAM);
  Receiver receiver(config);
  std::jthread thread([&](const std::stop_token& stop) { receiver.run(stop); });
  const Sending sent = send_stream(stream, config, seconds);
  std::this_thread::sleep_for(kDrain);
  thread.request_stop();
  thread.join();
  const UdpCounters& counters = receiver.counters();
  const LidarStatus status = receiver.status();
  std::printf("%-26s %7.0f %7.0f %8llu %8llu %7llu %7llu %7llu %8.1f %% %8.1f ms\n", stream.title.c_str(),
              static_cast<double>(sent.datagrams) / seconds, 8e-6 * static_cast<double>(sent.bytes) / seconds,
              static_cast<unsigned long long>(sent.datagrams),
              static_cast<unsigned long long>(counters.received),
              static_cast<unsigned long long>(counters.kernel_overflows),
              static_cast<unsigned long long>(status.packets_lost),
              static_cast<unsigned long long>(status.packets_rejected), 100.0 * receiver.cpu() / seconds,
              1e3 * to_seconds(sent.latest));
  std::fflush(stdout);
  for (const std::string& warning : receiver.warnings()) {
    static bool told = false;
    if (!std::exchange(told, true)) std::fprintf(stderr, "%s\n", warning.c_str());
  }
}

}  // namespace
}  // namespace hulltrack

int main(int argc, char** argv) {
  using namespace hulltrack;
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 2;
  if (seconds < 1) {
    std::fprintf(stderr, "usage: bench_receive [SECONDS]\n");
    return 2;
  }
  std::printf("%-26s %7s %7s %8s %8s %7s %7s %7s %10s %11s\n", "model", "1/s", "Mbit/s", "sent", "received",
              "kernel", "missed", "refused", "receiving", "late by");
  bench::for_each_sensor_stream([&](const bench::SensorStream& stream) { measure(stream, seconds); });
}
