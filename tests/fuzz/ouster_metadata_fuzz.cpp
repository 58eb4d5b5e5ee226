// Any text as an Ouster's metadata: an error names the file, and what is accepted gives a decoder that takes
// a datagram of every bit set and puts its points where a sensor can see.
#include <cstdint>
#include <string_view>

#include "tests/fuzz/ouster_fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hulltrack;
  using fuzz::require;
  const auto read = ouster::parse_metadata({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!read) {
    require(read.error().message.starts_with("fuzz: "));
    return 0;
  }
  const ouster::Metadata& metadata = *read;
  require(metadata.packet_bytes() <= ouster::kMaxPacketBytes);
  const ouster::OusterDecoder decoder(metadata, {.repeated_echoes = true});
  std::vector<std::uint8_t> bytes(metadata.packet_bytes(), 0xFF);
  fuzz::repair(bytes, metadata);
  DecodedPacket packet;
  const DecodeOutcome outcome = decoder.decode(bytes, packet);
  require(!decoder.explain(outcome).empty());
  if (!outcome.ok()) return 0;
  // The metadata may move the beams' origin and the sensor by up to a metre along each axis.
  fuzz::check(metadata, packet, ouster::kMaxRange + 10.0);
  return 0;
}
