// Any bytes as datagrams of a LiDAR, through decoder and scan builder.
//
// Input: one byte for model, framing and time source, then datagrams of {length u16, delay u16, bytes}. What
// claims to be whole is brought to a datagram's length and handed to `repair`, which puts right what the
// decoder looks at first, so that the search gets past the first checks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/scan_builder.hpp"

namespace hulltrack::fuzz {

inline void require(bool condition) {
  if (!condition) std::abort();
}

inline void check(const Scan& scan) {
  std::size_t next = 0;
  require(scan.points.size() <= kMaxLidarPoints * scan.lidars.size());
  for (const ScanSegment& segment : scan.segments) {
    require(segment.first == next && segment.count > 0 && segment.lidar < 2);
    next += segment.count;
  }
  require(next == scan.points.size());
}

/// Precondition: `input` is not empty. `repair(packet)` gets packets of `packet_bytes`.
template <typename Repair>
void run_datagrams(Bytes input, std::string_view model, std::size_t packet_bytes, const Repair& repair) {
  LidarConfig first;
  first.model = model;
  first.time_source = (input[0] & 0x10) != 0 ? TimeSource::sensor : TimeSource::receive;
  const Framing framing = (input[0] & 0x20) != 0 ? Framing::revolution : Framing::period;
  auto builder = ScanBuilder::create({first, first}, {framing, (input[0] & 0x40) != 0 ? 200.0 : 10.0});
  require(builder.ok());

  MeasurementTime time = measurement_time_from_ns(1'700'000'000'000'000'000);
  Scan scan;
  for (std::size_t at = 1; at + 4 <= input.size();) {
    const bool whole = (input[at] & 1) != 0;
    const std::size_t wanted = whole ? packet_bytes : read_le16(input, at) % 1500;
    const auto delay = static_cast<std::int16_t>(read_le16(input, at + 2));
    at += 4;
    const Bytes body = input.subspan(at, std::min(wanted, input.size() - at));
    at += body.size();
    std::vector<std::uint8_t> packet(body.begin(), body.end());
    if (whole) packet.resize(packet_bytes);
    if (packet.size() == packet_bytes) repair(packet);
    time += std::chrono::microseconds(std::int64_t{delay} * 100);
    Datagram datagram;
    datagram.bytes = packet;
    datagram.received = time;
    datagram.received_utc = WallTime{time.time_since_epoch()};
    static_cast<void>(builder->add(at % 2, datagram));
    if (delay % 16 == 0) builder->advance(time);
    while (builder->take(scan)) check(scan);
  }
  builder->finish();
  while (builder->take(scan)) check(scan);
  static_cast<void>(builder->status(0));
}

}  // namespace hulltrack::fuzz
