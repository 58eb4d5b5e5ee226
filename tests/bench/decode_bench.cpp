// What does decoding cost? Every model that can be imitated, at its full rate: all beams return.
//
// Prints for each the points a second that the sensor sends, the time a point, and the share of one core that
// decoding takes, alone and with all that the receiving thread does to make scans of it. Usage: bench_decode
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "tests/bench/sensor_streams.hpp"
#include "tests/bench/stopwatch.hpp"

namespace hulltrack {
namespace {

/// Median of nine, CPU seconds.
template <typename Work>
double seconds_of(Work&& work) {
  std::vector<double> times;
  for (int i = 0; i < 9; ++i) {
    bench::Stopwatch watch;
    work();
    times.push_back(1e-3 * watch.lap().cpu);
  }
  std::nth_element(times.begin(), times.begin() + 4, times.end());
  return times[4];
}

void measure(const bench::SensorStream& stream) {
  const LidarConfig& config = stream.config;
  auto decoder = make_lidar_decoder(*find_lidar_model(config.model), {}, config.calibration).value();
  decoder->inform(stream.information);
  DecodedPacket packet;
  std::size_t points = 0;
  const double decoding = seconds_of([&] {
    points = 0;
    for (const auto& datagram : stream.datagrams) {
      if (!decoder->decode(datagram, packet).ok()) std::abort();
      points += packet.points.size();
    }
  });
  auto builder = ScanBuilder::create({config}, {}).value();
  builder.add(0, {.bytes = stream.information});
  Scan scan;
  MeasurementTime second{};
  const double receiving = seconds_of([&] {  // its buffers have grown after the first second
    for (std::size_t i = 0; i < stream.datagrams.size(); ++i) {
      builder.add(0, {.bytes = stream.datagrams[i], .received = second + stream.sent[i]});
      while (builder.take(scan)) {
      }
    }
    second += bench::kStreamLength;
  });
  const double length = to_seconds(bench::kStreamLength);
  std::printf("%-26s %10.0f %8.1f %8.2f %% %8.2f %%\n", stream.title.c_str(),
              static_cast<double>(points) / length, 1e9 * decoding / static_cast<double>(points),
              100.0 * decoding / length, 100.0 * receiving / length);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hulltrack

int main() {
  using namespace hulltrack;
  std::printf("%-26s %10s %8s %10s %10s\n", "model", "points/s", "ns/point", "decoding", "receiving");
  bench::for_each_sensor_stream(measure);
}
