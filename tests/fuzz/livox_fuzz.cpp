// Any bytes as datagrams of every Livox model, through decoder and packet sequence.
//
// Input: one byte for the model, then datagrams of {kind u8, length u16, bytes}. One of an odd kind gets a
// proper header for a kind of record, so that the search gets past the first checks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/livox/livox_decoder.hpp"
#include "lidar_drivers/packet_sequence.hpp"

namespace {

using namespace hulltrack;

void require(bool condition) {
  if (!condition) std::abort();
}

void repair(std::vector<std::uint8_t>& packet, const livox::Generation& generation, std::uint8_t choice) {
  const livox::RecordKind& kind = generation.kinds[choice % generation.kinds.size()];
  const std::size_t records = kind.records > 0 ? kind.records : choice;
  packet.resize(generation.header + records * kind.bytes);
  packet[0] = generation.version;
  packet[generation.type_offset] = kind.type;
  if (kind.records > 0) return;
  write_le16(packet, livox::kLengthOffset, static_cast<std::uint16_t>(packet.size()));
  write_le16(packet, livox::kDotsOffset, static_cast<std::uint16_t>(records));
}

void check(const livox::ModelTable& model, const DecodedPacket& packet, std::size_t bytes) {
  require(packet.points.size() <=
          bytes / 5);  // the densest kind: two echoes of spherical records in 16 bytes
  require(packet.duration >= Nanoseconds::zero() && packet.duration < std::chrono::milliseconds(100));
  require(packet.interval >= packet.duration);
  for (const LidarPoint& point : packet.points) {
    require(point.dt_ns <= 0 && Nanoseconds(point.dt_ns) >= -packet.duration);
    require(std::abs(point.x) < 4.3e6F && std::abs(point.y) < 4.3e6F && std::abs(point.z) < 4.3e6F);
    require(point.channel < model.lines);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes input(data, size);
  const livox::ModelTable& model = livox::models()[input[0] % livox::models().size()];
  const livox::LivoxDecoder decoder(model, {.repeated_echoes = true});
  PacketSequence sequence(decoder.clock_wrap());
  MeasurementTime time = measurement_time_from_ns(1'700'000'000'000'000'000);
  DecodedPacket packet;
  for (std::size_t at = 1; at + 3 <= size;) {
    const std::uint8_t choice = input[at];
    const std::size_t wanted = read_le16(input, at + 1);
    at += 3;
    const Bytes body = input.subspan(at, std::min(wanted, size - at));
    at += body.size();
    std::vector<std::uint8_t> bytes(body.begin(), body.end());
    if (choice % 2 == 1) repair(bytes, *model.generation, choice / 2);
    const DecodeOutcome outcome = decoder.decode(bytes, packet);
    require(!decoder.explain(outcome).empty());
    if (!outcome.ok()) {
      require(packet.points.empty());
      continue;
    }
    check(model, packet, bytes.size());
    time += std::chrono::microseconds(480);
    static_cast<void>(sequence.note(bytes, packet, time));
  }
  return 0;
}
