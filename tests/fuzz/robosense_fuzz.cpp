// Any bytes as data and DIFOP datagrams of every RoboSense model.
//
// Input: one byte for the model and the options, then datagrams of {kind u8, length u8, bytes}. Kind 0 as
// they come, 8 times the length; of the others id and flags are put right, so that the search gets past the
// first checks: 1 a data packet, 2 a DIFOP packet, 3 one of 16 bytes whose angles differ.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/robosense/robosense_decoder.hpp"

namespace {

using namespace hulltrack;
using namespace hulltrack::robosense;

void require(bool condition) {
  if (!condition) std::abort();
}

void make_data(std::vector<std::uint8_t>& packet, Family family) {
  packet.resize(kPacketBytes);
  write_be32(packet, 0, family == Family::helios ? kHeliosId : kClassicId);
  if (family == Family::classic) write_be32(packet, 4, kClassicIdRest);
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const std::size_t at = kHeaderBytes + block * kBlockBytes;
    write_be16(packet, at, kBlockFlag);
    write_be16(packet, at + 2, read_be16(packet, at + 2) % kCentidegrees);
  }
}

void make_difop(std::vector<std::uint8_t>& packet) {
  packet.resize(kPacketBytes);
  std::ranges::copy(kDifopId, packet.begin());
}

void make_angles_differ(std::vector<std::uint8_t>& packet) {
  packet[kDifopReturnModeOffset] = packet[15];
  const std::size_t lowest = packet[14] % 2 == 0 ? 100 : 6000;  // 0.01 deg; 6000: a Bpearl's
  for (std::size_t k = 0; k < kSlots; ++k) {
    const auto angle = static_cast<std::uint16_t>(lowest + 50 * k);
    write_be16(packet, kDifopVerticalOffset + k * kAngleBytes + 1, angle);
    if (k < 16) write_be16(packet, kDifopRs16VerticalOffset + k * kAngleBytes + 1, angle);
  }
}

void check(const DecodedPacket& packet, const ModelTable& model) {
  require(packet.points.size() <= kBlocks * kSlots);
  require(packet.duration >= Nanoseconds::zero() && packet.duration <= std::chrono::milliseconds(310));
  require(packet.interval > Nanoseconds::zero());
  require(packet.rotation_rate >= 0.0 && packet.first_azimuth >= 0.0 && packet.last_azimuth >= 0.0);
  const double farthest = 65535 * model.distance_unit + model.lens_forward + model.lens_up + 0.001;
  for (const LidarPoint& point : packet.points) {
    require(std::hypot(point.x, point.y, point.z) <= farthest);
    require(point.dt_ns <= 0 && point.dt_ns >= -packet.duration.count());
    require(point.channel < model.lasers && point.echo <= 1);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes input(data, size);
  const ModelTable& model = models()[input[0] % models().size()];
  RobosenseDecoder decoder(
      model, {.firing_correction = (input[0] & 0x80) == 0, .repeated_echoes = (input[0] & 0x40) != 0});
  DecodedPacket packet;
  for (std::size_t at = 1; at + 2 <= size;) {
    const int kind = input[at] % 4;
    const std::size_t wanted = kind == 0 ? input[at + 1] * 8U : kind == 3 ? 16U : kPacketBytes;
    at += 2;
    const Bytes body = input.subspan(at, std::min(wanted, size - at));
    at += body.size();
    std::vector<std::uint8_t> bytes(body.begin(), body.end());
    if (kind == 1) make_data(bytes, model.family);
    if (kind >= 2) make_difop(bytes);
    if (kind == 3) make_angles_differ(bytes);
    static_cast<void>(decoder.inform(bytes));
    const DecodeOutcome outcome = decoder.decode(bytes, packet);
    require(!decoder.explain(outcome).empty());
    if (outcome.ok()) {
      check(packet, model);
    } else {
      require(packet.points.empty());
    }
  }
  return 0;
}
