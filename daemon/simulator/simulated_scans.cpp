#include "daemon/simulator/simulated_scans.hpp"

#include <algorithm>
#include <utility>

#include "daemon/simulator/parallel.hpp"
#include "daemon/simulator/recording.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack {

Result<std::vector<Scan>> simulated_scans(const SimulatedBerth& berth, int first, int count) {
  auto builder =
      ScanBuilder::create({berth.lidar_config()}, {.framing = Framing::period, .frame_rate_hz = 10.0});
  if (!builder) return builder.error();
  if (const auto about_itself = berth.information().datagram; !about_itself.empty())
    builder->add(0, {.bytes = about_itself, .received = SimulatedBerth::kEpoch});
  const Nanoseconds begin = first * SimulatedBerth::kFramePeriod;
  const Nanoseconds end = (first + count) * SimulatedBerth::kFramePeriod;
  // The first datagram's first firing opens the grid of frames, so it must not be before `begin`.
  std::uint64_t packet = 0;
  while (packet < berth.packets() && berth.encoder().first_firing(packet) < begin) ++packet;
  std::uint64_t last = packet;
  while (last < berth.packets() && berth.sent(last) < end) ++last;

  std::vector<SimulatedBerth::Packet> packets(last - packet);
  for_each_index(packets.size(), [&](std::size_t i) { packets[i] = berth.packet(packet + i); });
  std::vector<Scan> scans;
  Scan scan;
  const auto collect = [&] {
    while (builder->take(scan)) scans.push_back(std::exchange(scan, Scan{}));
  };
  for (std::size_t i = 0; i < packets.size(); ++i) {
    builder->add(0, {.bytes = packets[i], .received = SimulatedBerth::kEpoch + berth.sent(packet + i)});
    collect();
  }
  builder->finish();
  collect();
  if (scans.size() > static_cast<std::size_t>(count)) scans.resize(static_cast<std::size_t>(count));
  return scans;
}

std::vector<JointSample> simulated_joint_samples(const SimulatedBerth& berth) {
  const auto latency = nanoseconds_from_ms(berth.plc_model().mean_latency() * 1e3);
  std::vector<JointSample> samples;
  std::uint32_t heartbeat = 0;
  for (const PlcCsvRow& row : recorded_plc(berth)) {
    if (!samples.empty() && row.heartbeat == heartbeat) continue;
    heartbeat = row.heartbeat;
    samples.push_back({measurement_time_from_ns(row.t_ns) - latency,
                       {row.d_x, radians(row.theta_r_deg), radians(row.theta_p_deg)}});
  }
  return samples;
}

}  // namespace hulltrack
