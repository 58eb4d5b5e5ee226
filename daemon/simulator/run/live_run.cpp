#include "daemon/simulator/run/live_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "daemon/simulator/run/live_judge.hpp"
#include "daemon/simulator/run/packets_ahead.hpp"
#include "daemon/simulator/run/udp_sender.hpp"
#include "plc/sim/plc_server.hpp"

namespace hulltrack {
namespace {

SteadyTime now() { return std::chrono::time_point_cast<Nanoseconds>(std::chrono::steady_clock::now()); }

/// The PLC of the simulation: serves what the encoders say, judges what the service writes.
class LivePlc {
 public:
  LivePlc(const SimulatedBerth& berth, const LiveOptions& options)
      : berth_(berth),
        judge_(berth),
        server_({.bind = options.plc_bind, .port = options.plc_port, .read = {}, .write = {}}) {
    present(Nanoseconds{0});
  }

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }
  [[nodiscard]] bool read_by_service() const { return server_.requests() > 0; }

  /// Simulation time 0 is at `start`.
  void start(SteadyTime start) {
    server_.on_write([this, start](const sim::PlcWriteRecord& record) {
      const std::scoped_lock lock(mutex_);
      judge_.add(record.block, record.at - start);
    });
    cycles_ = std::jthread([this, start](const std::stop_token& stop) {
      for (std::int64_t cycle = 0; !stop.stop_requested(); ++cycle) {
        std::this_thread::sleep_until(start + berth_.plc_cycle(cycle));
        present(berth_.plc_cycle(cycle));
      }
    });
  }

  [[nodiscard]] std::string line(Nanoseconds time) const {
    const std::scoped_lock lock(mutex_);
    return judge_.line(time);
  }
  [[nodiscard]] std::vector<std::string> summary(Nanoseconds end) const {
    const std::scoped_lock lock(mutex_);
    return judge_.summary(end);
  }

 private:
  void present(Nanoseconds time) {
    const Joints joints = berth_.plc(time).joints;
    server_.set_joints(joints.d_x, degrees(joints.theta_r), degrees(joints.theta_p));
  }

  const SimulatedBerth& berth_;
  mutable std::mutex mutex_;
  LiveJudge judge_;
  sim::PlcServer server_;
  std::jthread cycles_;
};

void wait_for_service(const LivePlc& plc, const LiveHooks& hooks) {
  constexpr auto kLook = std::chrono::milliseconds(50);
  while (!plc.read_by_service() && hooks.keep_going()) std::this_thread::sleep_for(kLook);
}

}  // namespace

Result<void> run_live(const SimulatedBerth& berth, const LiveOptions& options, const LiveHooks& hooks) {
  std::vector<UdpSender> lidars;
  for (std::size_t i = 0; i < berth.lidars().size(); ++i) {
    auto lidar = UdpSender::create(options.lidar_host, static_cast<std::uint16_t>(options.lidar_port + i));
    if (!lidar) return lidar.error();
    lidars.push_back(std::move(*lidar));
  }
  std::unique_ptr<LivePlc> plc;
  try {
    if (options.with_plc) plc = std::make_unique<LivePlc>(berth, options);
  } catch (const std::runtime_error& failure) {
    return Error{
        std::string(failure.what()) +
        "; --plc-port names another port, --plc-bind an address of this host (`ip address` lists them)"};
  }
  if (auto told = hooks.listening(plc ? plc->port() : options.plc_port); !told) return told;
  PacketsAhead packets(berth);
  packets.wait_ready(PacketsAhead::kReady);
  if (plc) hooks.show("the PLC listens on port " + std::to_string(plc->port()));
  if (plc && options.wait_for_service) wait_for_service(*plc, hooks);

  const SteadyTime start = now();
  if (plc) plc->start(start);
  Nanoseconds latest{0};
  Nanoseconds next_line = std::chrono::seconds(1);
  const LiveJudge nobody(berth);
  const auto show = [&](Nanoseconds time) { hooks.show(plc ? plc->line(time) : nobody.ship_line(time)); };
  const auto keep_going_until = [&](Nanoseconds time) {
    for (; next_line <= time; next_line += std::chrono::seconds(1)) {
      std::this_thread::sleep_until(start + next_line);
      show(next_line);
      if (!hooks.keep_going()) return false;
    }
    std::this_thread::sleep_until(start + time);
    return true;
  };
  bool wanted = true;
  for (auto packet = packets.take(); packet; packet = packets.take()) {
    const Nanoseconds due = packet->departure.time;
    wanted = keep_going_until(due);
    if (!wanted) break;
    latest = std::max(latest, now() - start - due);
    if (auto sent = lidars[packet->departure.lidar].send(packet->bytes); !sent) return sent;
  }
  // What is unplugged until the end sends nothing, but the berth is still there.
  if (wanted) keep_going_until(berth.frames() * SimulatedBerth::kFramePeriod - std::chrono::milliseconds(1));
  const Nanoseconds end = now() - start;
  if (plc)
    for (const std::string& line : plc->summary(end)) hooks.show(line);
  if (latest > std::chrono::milliseconds(20))
    hooks.show("this host was too busy: datagrams left up to " +
               std::to_string(latest / std::chrono::milliseconds(1)) +
               " ms late, so the figures above are too bad");
  return {};
}

}  // namespace hulltrack
