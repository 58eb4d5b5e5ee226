// Any bytes as datagrams of every Velodyne model, through decoder and scan builder.
//
// Input: one byte for model, framing and time source, then datagrams of {length u16, delay u16, bytes}; with
// a length that fits, flags and product code are put right, so that the search gets past the first checks.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "lidar_drivers/bytes.hpp"
#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "lidar_drivers/velodyne/velodyne_format.hpp"

namespace {

using namespace hulltrack;

void repair(std::vector<std::uint8_t>& packet, std::uint8_t product) {
  if (packet.size() != velodyne::kPacketBytes) return;
  for (std::size_t block = 0; block < velodyne::kBlocks; ++block) {
    write_le16(packet, block * velodyne::kBlockBytes, velodyne::kBlockFlag);
  }
  packet[velodyne::kProductOffset] = product;
}

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const Scan& scan) {
  std::size_t next = 0;
  require(scan.points.size() <= kMaxScanPoints);
  for (const ScanSegment& segment : scan.segments) {
    require(segment.first == next && segment.count > 0 && segment.lidar < 2);
    next += segment.count;
  }
  require(next == scan.points.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes input(data, size);
  const std::size_t index = input[0] % velodyne::models().size();
  LidarConfig first;
  first.model = velodyne::models()[index].name;
  first.time_source = (input[0] & 0x10) != 0 ? TimeSource::sensor : TimeSource::receive;
  const Framing framing = (input[0] & 0x20) != 0 ? Framing::revolution : Framing::period;
  auto builder = ScanBuilder::create({first, first}, {framing, (input[0] & 0x40) != 0 ? 200.0 : 10.0});
  require(builder.ok());

  MeasurementTime time = measurement_time_from_ns(1'700'000'000'000'000'000);
  Scan scan;
  for (std::size_t at = 1; at + 4 <= size;) {
    const bool whole = (input[at] & 1) != 0;
    const std::size_t wanted = whole ? velodyne::kPacketBytes : read_le16(input, at) % 1500;
    const auto delay = static_cast<std::int16_t>(read_le16(input, at + 2));
    at += 4;
    const Bytes body = input.subspan(at, std::min(wanted, size - at));
    at += body.size();
    std::vector<std::uint8_t> packet(body.begin(), body.end());
    if (whole) packet.resize(velodyne::kPacketBytes);
    repair(packet, velodyne::models()[index].product);
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
  return 0;
}
