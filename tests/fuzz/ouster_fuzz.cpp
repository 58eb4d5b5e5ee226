// Any text as an Ouster's metadata, any bytes as its datagrams.
//
// Input: {length u16, text}, one byte for the profile, then datagrams of {kind u8, length u16, bytes}. Where
// the text is no metadata a good one stands in for it. A datagram of an odd kind is brought to its size and
// its header and measurement ids are put right, so that the search gets past the first checks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/ouster/ouster_decoder.hpp"
#include "lidar_drivers/packet_sequence.hpp"

namespace {

using namespace hulltrack;
using ouster::Metadata;

void require(bool condition) {
  if (!condition) std::abort();
}

Metadata good_metadata(std::uint8_t choice) {
  Metadata metadata;
  metadata.profile = static_cast<ouster::Profile>(choice % 4);
  metadata.beams.resize(16, {0.1, 0.05});
  if ((choice & 4) != 0) metadata.window_last = 700;
  return metadata;
}

void repair(std::vector<std::uint8_t>& packet, const Metadata& metadata) {
  packet.resize(metadata.packet_bytes());
  const ouster::Layout& layout = metadata.layout();
  if (layout.packet_header > 0) {
    write_le16(packet, 0, ouster::kLidarPacket);
    for (std::size_t i = 0; i < 5; ++i) packet[ouster::kSerialOffset + i] = 0;
  }
  const std::size_t first = read_le16(packet, layout.packet_header + ouster::kMeasurementIdOffset);
  for (std::size_t c = 0; c < metadata.columns_per_packet; ++c) {
    const std::size_t at = layout.packet_header + c * layout.column_bytes(metadata.beams.size());
    write_le16(packet, at + ouster::kMeasurementIdOffset, static_cast<std::uint16_t>(first % 1024 + c));
  }
}

void check(const Metadata& metadata, const DecodedPacket& packet) {
  require(packet.points.size() <= 2 * metadata.columns_per_packet * metadata.beams.size());
  require(packet.duration >= Nanoseconds::zero() && packet.duration < std::chrono::milliseconds(500));
  require(packet.interval > Nanoseconds::zero() && packet.rotation_rate > 0.0);
  require(!packet.counter || packet.counter->value < packet.counter->wrap);
  const double far = ouster::kMaxRange + 10.0;  // and the transforms' metres
  for (const LidarPoint& point : packet.points) {
    require(point.dt_ns <= 0 && Nanoseconds(point.dt_ns) >= -packet.duration);
    require(std::hypot(point.x, point.y, point.z) <= far);
    require(point.channel < metadata.beams.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes input(data, size);
  if (size < 3) return 0;
  const std::size_t text_size = std::min<std::size_t>(read_le16(input, 0), size - 3);
  const std::string_view text(reinterpret_cast<const char*>(data) + 2, text_size);
  std::size_t at = 2 + text_size;
  const auto read = ouster::parse_metadata(text, "fuzz");
  const Metadata metadata = read ? *read : good_metadata(input[at]);
  ++at;
  require(metadata.packet_bytes() <= ouster::kMaxPacketBytes);
  const ouster::OusterDecoder decoder(metadata, {.repeated_echoes = true});
  PacketSequence sequence(decoder.clock_wrap());
  MeasurementTime time = measurement_time_from_ns(1'700'000'000'000'000'000);
  DecodedPacket packet;
  while (at + 3 <= size) {
    const bool whole = (input[at] & 1) != 0;
    const std::size_t wanted = read_le16(input, at + 1);
    at += 3;
    const Bytes body = input.subspan(at, std::min(wanted, size - at));
    at += body.size();
    std::vector<std::uint8_t> bytes(body.begin(), body.end());
    if (whole) repair(bytes, metadata);
    const DecodeOutcome outcome = decoder.decode(bytes, packet);
    require(!decoder.explain(outcome).empty());
    if (!outcome.ok()) {
      require(packet.points.empty());
      continue;
    }
    check(metadata, packet);
    time += std::chrono::milliseconds(2);
    static_cast<void>(sequence.note(bytes, packet, time));
  }
  return 0;
}
