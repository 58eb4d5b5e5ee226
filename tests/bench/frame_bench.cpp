// How long does the service take from datagrams to registers, and to start?
//
// Of each method, measured on HullTracker itself by way of FramePipeline, with decoding before and the
// registers after it. The first frames, which search the berth as well, are counted apart. The default
// method must track every frame after these, and no healthy pose may be wrong, or the run is void. Figures go
// to stdout as JSON, CPU time of the one thread that does it all besides time on the wall; scripts/bench runs
// this and prints them.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/percentile.hpp"
#include "core/io/map_file.hpp"
#include "core/io/pcd_writer.hpp"
#include "daemon/pipeline/frame_pipeline.hpp"
#include "daemon/pipeline/publication.hpp"
#include "plc/register_codec.hpp"
#include "tests/bench/bench_process.hpp"
#include "tests/bench/frame_parts.hpp"
#include "tests/bench/stopwatch.hpp"
#include "tests/support/bench_scene.hpp"
#include "tests/support/frame_recording.hpp"

namespace hulltrack::bench {
namespace {

constexpr int kFrames = 60;
constexpr std::uint32_t kFramesToBelieve = 30;  // of them: the search of the berth, landmarks, recovery
constexpr int kRounds = 5;
constexpr std::uint32_t kSeed = 1;
constexpr double kMapSpacing = 0.05;  // m
constexpr double kWrong = 0.05;       // m

/// Writes the scene's map where only this process looks for it.
std::filesystem::path write_map() {
  const auto file =
      std::filesystem::temp_directory_path() / ("frame_bench_" + std::to_string(getpid()) + ".pcd");
  require(static_cast<bool>(write_pcd(file, make_scene(kMapSpacing, 0, kSeed).map_H)), "no map written");
  return file;
}

/// ms a frame.
struct Times {
  std::vector<double> cpu;
  std::vector<double> wall;

  void add(const Milliseconds& t) {
    cpu.push_back(t.cpu);
    wall.push_back(t.wall);
  }
};

struct Figures {
  Times settled;  // whole frames
  Times first;    // whole frames, the first kFramesToBelieve
  Times decode;
  Times process;  // HullTracker::process
  Times publish;
  double points = 0.0;   // of all settled frames
  double matched = 0.0;  // likewise
  double healthy = 0.0;  // settled frames with health
};

/// A healthy pose is right, and the default method's are healthy once it has found the hull.
void check(const FrameRecording& recording, RegistrationMethod method, const TrackResult& track,
           const WriteBlock& block) {
  const Eigen::Vector3d middle(0.0, 10.0, 2.0);
  const double error = (track.pose.T_W_H * middle - recording.T_W_H * middle).norm();
  const bool believed = track.state == State::tracking && block.health;
  require(!believed || error < kWrong, "a healthy pose is wrong");
  if (!believed && track.frame >= kFramesToBelieve && method == RegistrationMethod::automatic) {
    std::fprintf(stderr, "frame %u: %s\n", track.frame, track.reason.c_str());
    require(false, "a frame without health");
  }
}

/// Datagrams to registers, as rx, track and plc do it between them.
void time_frames(const FrameRecording& recording, RegistrationMethod method,
                 const std::shared_ptr<const HullMap>& map, Figures& figures) {
  Config config = config_for(recording);
  config.tracker.registration.method = method;
  FramePipeline pipeline(config, map);
  Publication publication(config.tracker.health.max_age);
  Stopwatch watch;
  play(recording, [&](const Scan& scan) {
    const Milliseconds decoding = watch.lap();
    const FrameReport report = pipeline.process(scan, recording.joints, {});
    const Milliseconds tracking = watch.lap();
    const MeasurementTime now = scan.last_firing;
    publication.frame(report.track, now, report.processing);
    const WriteBlock block = publication.block({}, now);
    const WriteRegisters registers = encode_write_block(block, config.plc.write);
    const Milliseconds publishing = watch.lap();
    require(decode_write_block(registers, config.plc.write).frame <= report.track.frame, "other registers");
    check(recording, method, report.track, block);
    Milliseconds whole = decoding;
    whole += tracking;
    whole += publishing;
    if (report.track.frame >= kFramesToBelieve) {
      figures.settled.add(whole);
      figures.decode.add(decoding);
      figures.process.add(tracking);
      figures.publish.add(publishing);
      figures.points += static_cast<double>(scan.points.size());
      figures.matched += report.track.matched;
      figures.healthy += report.track.state == State::tracking ? 1.0 : 0.0;
    } else {
      figures.first.add(whole);
    }
    watch.lap();
  });
}

using Output = std::map<std::string, double>;

void report(const std::string& method, const Figures& figures, Output& out) {
  const auto add = [&](const std::string& what, Times times) {
    out[method + ' ' + what + "_median_cpu_ms"] = percentile(times.cpu, 0.5);
    out[method + ' ' + what + "_median_wall_ms"] = percentile(times.wall, 0.5);
    out[method + ' ' + what + "_p99_cpu_ms"] = percentile(times.cpu, 0.99);
    out[method + ' ' + what + "_p99_wall_ms"] = percentile(times.wall, 0.99);
  };
  add("settled", figures.settled);
  add("first", figures.first);
  add("decode", figures.decode);
  add("process", figures.process);
  add("publish", figures.publish);
  const auto frames = static_cast<double>(figures.settled.cpu.size());
  out[method + " frames"] = frames;
  out[method + " tracking_percent"] = 100.0 * figures.healthy / frames;
  out[method + " points"] = figures.points / frames;
  out[method + " matched"] = figures.matched / frames;
}

void print(const Output& figures) {
  const char* separator = "{";
  for (const auto& [name, value] : figures) {
    std::printf("%s\"%s\": %.3f", separator, name.c_str(), value);
    separator = ",\n ";
  }
  std::printf("}\n");
}

void run() {
  const FrameRecording recording = record_frames(kFrames, kSeed);
  const std::filesystem::path map_file = write_map();
  const double memory_before = peak_memory_mb();
  Stopwatch watch;
  Result<MapFile> read = read_map_file(map_file);
  const Milliseconds reading = watch.lap();
  std::filesystem::remove(map_file);
  require(static_cast<bool>(read), "the map cannot be read");
  watch.lap();
  const auto map = std::make_shared<const HullMap>(std::move(read->cloud));
  const Milliseconds preparing = watch.lap();

  Figures automatic;
  for (int round = 0; round < kRounds; ++round) {
    time_frames(recording, RegistrationMethod::automatic, map, automatic);
  }
  const double memory = peak_memory_mb();
  Figures published;
  Parts parts;
  Parts start_parts;
  for (int round = 0; round < kRounds; ++round) {
    time_frames(recording, RegistrationMethod::point_to_point, map, published);
    time_frame_parts(recording, *map, parts);
  }
  time_map_parts(map->cloud_H(), start_parts);

  Output out = {
      {"clutter_percent", 100.0 * recording.clutter},
      {"map_points", static_cast<double>(map->cloud_H().size())},
      {"map_planes", static_cast<double>(map->planes().planes().size())},
      {"map_rims", static_cast<double>(map->rims().size())},
      {"map_read_cpu_ms", reading.cpu},
      {"map_read_wall_ms", reading.wall},
      {"map_prepare_cpu_ms", preparing.cpu},
      {"map_prepare_wall_ms", preparing.wall},
      {"peak_rss_mb_before", memory_before},
      {"peak_rss_mb", memory},
  };
  report("auto", automatic, out);
  report("point_to_point", published, out);
  for (auto& [part, times] : parts) {
    out["part " + part] = percentile(times, 0.5);
  }
  for (auto& [part, times] : start_parts) {
    out["start " + part] = percentile(times, 0.5);
  }
  print(out);
}

}  // namespace
}  // namespace hulltrack::bench

int main() { hulltrack::bench::run(); }
