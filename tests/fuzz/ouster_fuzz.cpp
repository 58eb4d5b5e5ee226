// Any bytes as datagrams of an Ouster, of each profile, with the whole turn or a window of it.
//
// Input: one byte for profile and window, then up to 8 datagrams of {kind u8, length u16, bytes}; one of an
// odd kind is repaired. The metadata are given (fuzz_ouster_metadata searches those) and of the smallest
// sensor: decoders are made once, so that a run costs what its datagrams cost.
#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

#include "lidar_drivers/packet_sequence.hpp"
#include "tests/fuzz/ouster_fuzz.hpp"

namespace {

using namespace hulltrack;
using fuzz::require;

constexpr std::uint8_t kProfiles = 4;
constexpr int kMostDatagrams = 8;
constexpr double kFar = ouster::kMaxRange + 0.1;  // and the sensor's own centimetres

struct Sensor {
  explicit Sensor(const ouster::Metadata& told) : metadata(told), decoder(told, {.repeated_echoes = true}) {}
  ouster::Metadata metadata;
  ouster::OusterDecoder decoder;
};

ouster::Metadata metadata_of(std::uint8_t choice) {
  ouster::Metadata metadata;
  metadata.profile = static_cast<ouster::Profile>(choice % kProfiles);
  metadata.beams.resize(16, {0.1, 0.05});
  metadata.beam_origin_x = metadata.beam_origin_distance = 15.8;
  metadata.lidar_to_sensor.translation().z() = 0.036;
  if (choice >= kProfiles) metadata.window_last = 700;
  return metadata;
}

const Sensor& sensor_of(std::uint8_t choice) {
  static const std::deque<Sensor> kSensors = [] {
    std::deque<Sensor> all;  // a decoder does not move
    for (std::uint8_t i = 0; i < 2 * kProfiles; ++i) all.emplace_back(metadata_of(i));
    return all;
  }();
  return kSensors[choice % kSensors.size()];
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes input(data, size);
  const auto& [metadata, decoder] = sensor_of(input[0]);
  PacketSequence sequence(decoder.clock_wrap());
  MeasurementTime time = measurement_time_from_ns(1'700'000'000'000'000'000);
  DecodedPacket packet;
  std::size_t at = 1;
  for (int n = 0; n < kMostDatagrams && at + 3 <= size; ++n) {
    const bool whole = (input[at] & 1) != 0;
    const std::size_t wanted = read_le16(input, at + 1);
    at += 3;
    const Bytes body = input.subspan(at, std::min(wanted, size - at));
    at += body.size();
    std::vector<std::uint8_t> bytes(body.begin(), body.end());
    if (whole) fuzz::repair(bytes, metadata);
    const DecodeOutcome outcome = decoder.decode(bytes, packet);
    require(!decoder.explain(outcome).empty());
    if (!outcome.ok()) {
      require(packet.points.empty());
      continue;
    }
    fuzz::check(metadata, packet, kFar);
    time += std::chrono::milliseconds(2);
    static_cast<void>(sequence.note(bytes, packet, time));
  }
  return 0;
}
