// What does decoding cost? Every model that can be imitated, at its full rate: all beams return.
//
// Prints for each the points a second that the sensor sends, the time a point, and the share of one core that
// decoding takes, alone and with all that the receiving thread does to make scans of it. Usage: bench_decode
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "lidar_drivers/model_registry.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "lidar_drivers/sim/encoder_registry.hpp"
#include "tests/bench/stopwatch.hpp"
#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

struct Stream {
  std::vector<std::vector<std::uint8_t>> datagrams;
  std::vector<Nanoseconds> sent;
  Nanoseconds length{};
  sim::SensorInformation information;
};

/// A second of a sensor for which everything is 10 m away.
Stream stream_of(const sim::LidarEncoder& encoder, std::size_t echoes) {
  Stream stream{.length = std::chrono::seconds(1), .information = encoder.information()};
  for (std::uint64_t n = 0; encoder.first_firing(n) < stream.length; ++n) {
    std::vector<sim::LaserReturn> returns(echoes * encoder.firings_per_packet());
    for (std::size_t i = 0; i < returns.size(); ++i) returns[i] = {i % 2 == 0 ? 10.0 : 8.0, 100};
    stream.datagrams.push_back(encoder.encode(n, returns));
    stream.sent.push_back(encoder.last_firing(n));
  }
  return stream;
}

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

void measure(const LidarModel& model, ReturnMode mode) {
  const auto encoder = sim::make_lidar_encoder(model.name, {.return_mode = mode});
  if (!encoder) return;
  const Stream stream = stream_of(**encoder, mode == ReturnMode::dual ? 2 : 1);
  const test::TempFolder folder;
  LidarConfig config{.model = std::string(model.name)};
  if (!stream.information.calibration_name.empty()) {
    config.calibration = (folder.path() / stream.information.calibration_name).string();
    std::ofstream(config.calibration) << stream.information.calibration;
  }
  auto decoder = make_lidar_decoder(model, {}, config.calibration).value();
  decoder->inform(stream.information.datagram);
  DecodedPacket packet;
  std::size_t points = 0;
  const double decoding = seconds_of([&] {
    points = 0;
    for (const auto& datagram : stream.datagrams) {
      if (!decoder->decode(datagram, packet).ok()) std::abort();
      points += packet.points.size();
    }
  });
  const double receiving = seconds_of([&] {
    auto builder = ScanBuilder::create({config}, {}).value();
    builder.add(0, {.bytes = stream.information.datagram});
    Scan scan;
    for (std::size_t i = 0; i < stream.datagrams.size(); ++i) {
      builder.add(0, {.bytes = stream.datagrams[i], .received = MeasurementTime{stream.sent[i]}});
      while (builder.take(scan)) {
      }
    }
  });
  const double length = to_seconds(stream.length);
  std::printf("%-20s %-10s %10.0f %8.1f %8.2f %% %8.2f %%\n", std::string(model.name).c_str(),
              return_mode_name(mode), static_cast<double>(points) / length,
              1e9 * decoding / static_cast<double>(points), 100.0 * decoding / length,
              100.0 * receiving / length);
}

}  // namespace
}  // namespace hulltrack

int main() {
  using namespace hulltrack;
  std::printf("%-20s %-10s %10s %8s %10s %10s\n", "model", "returns", "points/s", "ns/point", "decoding",
              "receiving");
  for (const LidarModel& model : lidar_models()) {
    measure(model, ReturnMode::strongest);
    measure(model, ReturnMode::dual);
  }
}
