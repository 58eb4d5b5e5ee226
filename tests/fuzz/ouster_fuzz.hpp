// What holds of every Ouster datagram that a decoder takes, whatever its metadata.
#pragma once

#include <cmath>
#include <cstdlib>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/ouster/ouster_decoder.hpp"

namespace hulltrack::fuzz {

inline void require(bool condition) {
  if (!condition) std::abort();
}

/// Brings a datagram to its size and puts right its header and measurement ids, so that the search gets past
/// the first checks.
inline void repair(std::vector<std::uint8_t>& packet, const ouster::Metadata& metadata) {
  packet.resize(metadata.packet_bytes());
  const ouster::Layout& layout = metadata.layout();
  if (layout.packet_header > 0) {
    write_le16(packet, 0, ouster::kLidarPacket);
    for (std::size_t i = 0; i < 5; ++i) packet[ouster::kSerialOffset + i] = 0;
  }
  const std::size_t first = read_le16(packet, layout.packet_header + ouster::kMeasurementIdOffset);
  const auto columns = static_cast<std::size_t>(metadata.columns_per_frame);
  for (std::size_t c = 0; c < metadata.columns_per_packet; ++c) {
    const std::size_t at = layout.packet_header + c * layout.column_bytes(metadata.beams.size());
    write_le16(packet, at + ouster::kMeasurementIdOffset, static_cast<std::uint16_t>(first % columns + c));
  }
}

/// `far`: m, from where no return comes.
inline void check(const ouster::Metadata& metadata, const DecodedPacket& packet, double far) {
  require(packet.points.size() <= 2 * metadata.columns_per_packet * metadata.beams.size());
  require(packet.duration >= Nanoseconds::zero() && packet.duration < std::chrono::milliseconds(500));
  require(packet.interval > Nanoseconds::zero() && packet.rotation_rate > 0.0);
  require(!packet.counter || packet.counter->value < packet.counter->wrap);
  for (const LidarPoint& point : packet.points) {
    require(point.dt_ns <= 0 && Nanoseconds(point.dt_ns) >= -packet.duration);
    require(std::hypot(point.x, point.y, point.z) <= far);
    require(point.channel < metadata.beams.size());
  }
}

}  // namespace hulltrack::fuzz
