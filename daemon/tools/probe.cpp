// `hulltrack probe`: what arrives, and what stands in the PLC's registers. For the person on the ladder.
#include <poll.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/base/text.hpp"
#include "daemon/tools/plc_table.hpp"
#include "daemon/tools/tools.hpp"
#include "lidar_drivers/datagram_router.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/pcap_source.hpp"
#include "lidar_drivers/recognition.hpp"
#include "lidar_drivers/udp_source.hpp"

namespace hulltrack {
namespace {

struct ProbeOptions {
  std::string capture;
  std::vector<std::uint16_t> ports;
  double seconds = 3.0;
  std::string plc;
  int base = 0;
  int count = 8;
  int unit = 1;
};

volatile std::sig_atomic_t g_interrupted = 0;

using Senders = std::map<std::uint32_t, Recognition>;

/// The senders of a network can be many; LiDARs are few.
constexpr std::size_t kMostSenders = 16;

void note(Senders& senders, const Datagram& datagram) {
  if (senders.contains(datagram.source_ip) || senders.size() < kMostSenders)
    senders[datagram.source_ip].add(datagram);
}

/// Every port that a model of the registry uses from the factory.
std::vector<std::uint16_t> factory_ports() {
  std::set<std::uint16_t> ports;
  for (const LidarModel& model : lidar_models()) {
    ports.insert(model.port);
    if (model.information_port != 0) ports.insert(model.information_port);
  }
  return {ports.begin(), ports.end()};
}

std::string list_of(const std::vector<std::uint16_t>& ports) {
  std::string text;
  for (const std::uint16_t port : ports) text += (text.empty() ? "" : ", ") + std::to_string(port);
  return text;
}

void listen(const ProbeOptions& options, const std::vector<std::uint16_t>& ports, Senders& senders) {
  std::vector<UdpSource> sockets;
  std::vector<pollfd> waiting;
  for (const std::uint16_t port : ports) {
    LidarConfig any;
    any.name = "probe";
    any.port = port;
    auto socket = UdpSource::open(std::span(&any, 1));
    if (!socket) {
      std::fprintf(stderr, "%s\n", socket.error().message.c_str());
      continue;
    }
    sockets.push_back(std::move(socket).value());
    waiting.push_back({sockets.back().fd(), POLLIN, 0});
  }
  if (sockets.empty()) throw ToolError("no port could be opened; stop what listens there and try again");
  std::fprintf(stderr, "listening on UDP port %s for %.0f s\n", list_of(ports).c_str(), options.seconds);
  std::signal(SIGINT, [](int) { g_interrupted = 1; });
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  while (g_interrupted == 0 && std::chrono::steady_clock::now() < end) {
    if (poll(waiting.data(), waiting.size(), 50) <= 0) continue;
    for (UdpSource& socket : sockets) {
      const auto datagrams = socket.receive();
      if (!datagrams) throw ToolError(datagrams.error().message);
      for (const Datagram& datagram : *datagrams) note(senders, datagram);
    }
  }
}

void read_capture(const ProbeOptions& options, Senders& senders) {
  auto capture = PcapSource::open(options.capture);
  if (!capture) throw ToolError(capture.error().message);
  Datagram datagram;
  auto more = capture->next(datagram);
  for (; more && *more; more = capture->next(datagram)) note(senders, datagram);
  if (!more) std::fprintf(stderr, "%s\n", more.error().message.c_str());
  if (senders.empty()) throw ToolError(capture->explain_nothing_found());
}

void row(const char* name, const std::string& value) { std::printf("  %-12s %s\n", name, value.c_str()); }

void show_traffic(std::uint32_t sender, const Recognition& recognition) {
  std::printf("%s\n", format_ipv4(sender).c_str());
  for (const Recognition::Traffic& traffic : recognition.traffic()) {
    std::string sizes;
    for (const auto& [bytes, count] : traffic.sizes)
      sizes += (sizes.empty() ? "" : ", ") + std::to_string(bytes) + " bytes" +
               (traffic.sizes.size() > 1 ? " (" + std::to_string(count) + ")" : "");
    row("to port", format_text("%u: %s of %s", traffic.port, counted(traffic.datagrams, "datagram").c_str(),
                               sizes.c_str()));
  }
}

void show_status(const LidarStatus& status) {
  if (status.packets == 0) return;
  row("returns", return_mode_name(status.return_mode));
  if (status.rpm > 0.0) row("rotation", format_text("%.0f rpm", status.rpm));
  if (status.packets_per_second > 0.0)
    row("rate", format_text("%.0f datagrams/s", status.packets_per_second));
  row("lost", format_text("%.1f %% (%llu)",
                          100.0 * static_cast<double>(status.packets_lost) /
                              static_cast<double>(status.packets + status.packets_lost),
                          static_cast<unsigned long long>(status.packets_lost)));
  if (status.field_of_view_cut) row("sector", "it leaves sectors out");
  row("clock", clock_words(status.clock));
}

/// The verdict on one sender, and what to do next.
void show_verdict(std::uint32_t sender, const Recognition& recognition) {
  const auto candidates = recognition.candidates();
  const std::uint16_t port = recognition.traffic().front().port;
  if (candidates.empty()) {
    std::printf(
        "  verdict      no LiDAR that this version knows, or not as it comes from the factory\n"
        "  next         compare its manual with `hulltrack models`; is %s the sensor at all?\n",
        format_ipv4(sender).c_str());
    return;
  }
  const Recognition::Candidate& best = candidates.front();
  std::string names;
  for (const Recognition::Candidate& candidate : candidates)
    names += (names.empty() ? "" : " or ") + std::string(candidate.model->name);
  const LidarStatus& status = best.status;
  show_status(status);
  row("verdict", std::string(best.model->vendor) + ": " + names);
  const bool untold = status.packets == 0 && status.packets_held_back > 0;
  if (best.shape_alone) {
    row("next", "get its " + std::string(best.model->calibration_file) + " and give it as `calibration`");
  } else if (untold) {
    row("next", status.angles_contradicted
                    ? "what it tells of its lasers' angles contradicts itself: listen longer"
                    : format_text("its lasers' angles did not arrive: let UDP port %u through as well",
                                  best.model->information_port));
  } else if (candidates.size() > 1) {
    row("next", "their datagrams are alike: read the type plate, set `model`");
  } else if (status.packets_lost * 50 > status.packets) {
    row("next", "more than 2 % get lost: check cable, switch and this computer's load");
  } else {
    row("next", format_text("[[lidar]] model = \"%s\", port = %u, source = \"%s\"",
                            std::string(best.model->name).c_str(), port, format_ipv4(sender).c_str()));
  }
}

void probe(const ProbeOptions& options) {
  if (!options.plc.empty()) print_plc_table(options.plc, options.unit, options.base, options.count);
  const auto ports = options.ports.empty() ? factory_ports() : options.ports;
  Senders senders;
  if (options.capture.empty()) {
    listen(options, ports, senders);
  } else {
    read_capture(options, senders);
  }
  for (const auto& [sender, recognition] : senders) {
    show_traffic(sender, recognition);
    show_verdict(sender, recognition);
  }
  if (senders.empty())
    throw ToolError(
        "nothing arrived on UDP port " + list_of(ports) +
        "; is the sensor powered and its host address this computer's (`ip address`), the cable in, "
        "a firewall open? `tcpdump -ni any udp` shows other ports");
}

}  // namespace

void add_probe(CLI::App& app) {
  auto options = std::make_shared<ProbeOptions>();
  CLI::App* command =
      app.add_subcommand("probe", "What a LiDAR sends here, and what stands in the PLC's registers.");
  command->footer(
      "Examples:\n"
      "  hulltrack probe                                every port that a known LiDAR uses, for 3 s\n"
      "  hulltrack probe --port 2369 --seconds 20\n"
      "  hulltrack probe capture.pcap\n"
      "  hulltrack probe --plc 192.168.10.10 --base 0   registers as floats in all four word orders");
  auto* capture = command->add_option("PCAP", options->capture, "A capture instead of the network");
  command->add_option("--port", options->ports, "UDP port to listen on, may be given several times")
      ->excludes(capture);
  command->add_option("--seconds", options->seconds, "How long to listen")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str()
      ->excludes(capture);
  auto* plc =
      command->add_option("--plc", options->plc, "HOST or HOST:PORT of the PLC: show its registers too");
  command->add_option("--base", options->base, "First register")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->needs(plc);
  command->add_option("--count", options->count, "Registers to read")
      ->check(CLI::Range(2, 125))
      ->capture_default_str()
      ->needs(plc);
  command->add_option("--unit-id", options->unit, "Modbus unit identifier")
      ->check(CLI::Range(0, 255))
      ->capture_default_str()
      ->needs(plc);
  command->callback([options] { probe(*options); });
}

}  // namespace hulltrack
