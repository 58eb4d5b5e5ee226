// Any bytes as a capture file.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numeric>

#include "lidar_drivers/pcap_source.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  // fmemopen with "r" does not write, whatever its signature says.
  std::FILE* stream = fmemopen(const_cast<std::uint8_t*>(data), size, "rb");
  if (stream == nullptr) return 0;
  auto source = hulltrack::PcapSource::open(stream, "fuzz");
  if (!source) return 0;
  hulltrack::Datagram datagram;
  unsigned sum = 0;
  for (auto more = source->next(datagram); more && *more; more = source->next(datagram)) {
    sum = std::accumulate(datagram.bytes.begin(), datagram.bytes.end(), sum);  // touches every byte
  }
  if (source->counters().datagrams > source->counters().records) std::abort();
  return sum == 0xFFFFFFFF ? -1 : 0;
}
