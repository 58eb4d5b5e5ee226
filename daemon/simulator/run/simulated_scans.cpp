#include "daemon/simulator/run/simulated_scans.hpp"

#include <algorithm>
#include <utility>

#include "daemon/simulator/parallel.hpp"
#include "daemon/simulator/run/departures.hpp"
#include "daemon/simulator/run/recording.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack {

Result<std::vector<Scan>> simulated_scans(const SimulatedBerth& berth, int first, int count) {
  auto builder =
      ScanBuilder::create(berth.lidar_configs(), {.framing = Framing::period, .frame_rate_hz = 10.0});
  if (!builder) return builder.error();
  // The first datagram's first firing opens the grid of frames, so it must not be before the first frame.
  Departures departures(berth, first * SimulatedBerth::kFramePeriod);
  const Nanoseconds end = (first + count) * SimulatedBerth::kFramePeriod;
  std::vector<Departure> sent;
  for (auto next = departures.next(); next && next->time < end; next = departures.next())
    sent.push_back(*next);

  std::vector<SimulatedBerth::Packet> packets(sent.size());
  for_each_index(packets.size(), [&](std::size_t i) { packets[i] = bytes_of(berth, sent[i]); });
  std::vector<Scan> scans;
  Scan scan;
  const auto collect = [&] {
    while (builder->take(scan)) scans.push_back(std::exchange(scan, Scan{}));
  };
  for (std::size_t i = 0; i < packets.size(); ++i) {
    builder->add(sent[i].lidar, {.bytes = packets[i], .received = SimulatedBerth::kEpoch + sent[i].time});
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
