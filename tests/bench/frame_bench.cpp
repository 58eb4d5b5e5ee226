// How long does the service take from datagrams to registers, and to start?
//
// Times are CPU time of the one thread that does it all. Every frame must come out healthy and near the
// truth, or the run is void. Figures go to stdout as JSON; scripts/bench runs this and prints them. The split
// by parts runs the parts one by one over the same frames, in HullTracker's order.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "core/filter/voxel_filter.hpp"
#include "core/io/map_file.hpp"
#include "core/io/pcd_writer.hpp"
#include "core/registration/point_to_point_icp.hpp"
#include "core/tracking/integrity.hpp"
#include "core/tracking/visibility.hpp"
#include "daemon/app/frame_pipeline.hpp"
#include "daemon/app/publication.hpp"
#include "lidar_drivers/scan_builder.hpp"
#include "plc/register_codec.hpp"
#include "tests/bench/bench_process.hpp"
#include "tests/bench/frame_recording.hpp"
#include "tests/support/bench_scene.hpp"

namespace hulltrack::bench {
namespace {

constexpr int kFrames = 30;
constexpr int kRounds = 7;
constexpr std::uint32_t kSeed = 1;
constexpr double kMapSpacing = 0.05;  // m
constexpr double kWrong = 0.05;       // m

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// Milliseconds since the last lap.
class Stopwatch {
 public:
  double lap() {
    const double now = cpu_ms();
    return now - std::exchange(last_, now);
  }

 private:
  double last_ = cpu_ms();
};

double percentile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1) + 0.5)];
}

/// Writes the scene's map where only this process looks for it.
std::filesystem::path write_map() {
  const auto file =
      std::filesystem::temp_directory_path() / ("frame_bench_" + std::to_string(getpid()) + ".pcd");
  require(static_cast<bool>(write_pcd(file, make_scene(kMapSpacing, 0, kSeed).map_H)), "no map written");
  return file;
}

struct Figures {
  std::vector<double> frame;                         // ms
  std::map<std::string, std::vector<double>> parts;  // ms a frame
  double points = 0.0;                               // of all frames
};

Config config_for(const FrameRecording& recording) {
  Config config;
  config.lidars = {recording.lidar};
  config.framing = recording.framing;
  return config;
}

/// Datagrams in, frames out; on_scan(scan, ms that decoding took).
template <typename OnScan>
void play(const FrameRecording& recording, OnScan&& on_scan) {
  ScanBuilder builder = ScanBuilder::create({recording.lidar}, recording.framing).value();
  Scan scan;
  Stopwatch watch;
  for (const RecordedDatagram& datagram : recording.datagrams) {
    builder.add(0, {.bytes = datagram.bytes, .received = datagram.received});
    if (builder.take(scan)) {
      on_scan(scan, watch.lap());
      watch.lap();
    }
  }
}

void check(const FrameRecording& recording, const TrackResult& track, const WriteBlock& block) {
  const bool recovering = track.frame + 1 < static_cast<std::uint32_t>(HealthConfig{}.recover_frames);
  if (!track.health && !recovering) {
    std::fprintf(stderr, "frame %u: %s\n", track.frame, track.reason.c_str());
  }
  require(recovering || block.health, "a frame without health");
  const Eigen::Vector3d middle(0.0, 10.0, 2.0);
  require((track.T_W_H * middle - recording.T_W_H * middle).norm() < kWrong, "a pose is wrong");
}

/// Datagrams to registers, as rx, track and plc do it between them.
void time_frames(const FrameRecording& recording, const std::shared_ptr<const HullMap>& map,
                 Figures& figures) {
  const Config config = config_for(recording);
  FramePipeline pipeline(config, map);
  Publication publication(config.tracker.health.max_age);
  play(recording, [&](const Scan& scan, double decoding) {
    Stopwatch watch;
    const FrameReport report = pipeline.process(scan, recording.joints, {});
    const double tracking = watch.lap();
    const SteadyTime now{scan.last_firing.time_since_epoch()};
    publication.frame(report.track, now, report.processing);
    const WriteBlock block = publication.block({}, now);
    const WriteRegisters registers = encode_write_block(block, config.plc.write);
    const double publishing = watch.lap();
    require(decode_write_block(registers, config.plc.write).frame <= report.track.frame, "other registers");
    check(recording, report.track, block);
    figures.points += static_cast<double>(scan.points.size());
    figures.frame.push_back(decoding + tracking + publishing);
    figures.parts["decode"].push_back(decoding);
    figures.parts["publish"].push_back(publishing);
  });
}

void time_parts(const FrameRecording& recording, const HullMap& map, Figures& figures) {
  const Config config = config_for(recording);
  const ScanFilter filter(config.machine, sensor_configs(config.lidars), std::nullopt);
  VoxelFilter voxels(config.tracker.registration.voxel_size);
  PointToPointIcp icp(IcpConfig{});
  Visibility visibility(config.tracker.health.metric_range);
  Integrity integrity;
  FilteredScan filtered;
  Cloud thinned_W;
  std::vector<ScanView> views(1);
  std::vector<VisiblePoint> visible;
  Cloud measured_W;
  std::vector<Neighbour> nearest;
  play(recording, [&](const Scan& scan, double) {
    Stopwatch watch;
    const auto done = [&](const char* part) { figures.parts[part].push_back(watch.lap()); };
    filter.run(scan, recording.joints, {}, filtered);
    done("deskew");
    voxels.filter(filtered.hull_W, thinned_W);
    done("voxels");
    const Pose T_W_H = icp.align(thinned_W, map.tree(), Pose::Identity()).T_target_source.inverse();
    done("icp");
    const Joints joints = recording.joints.at(scan.mid_time()).joints;
    views[0].rebuild(filtered.returns_W[0], lidar_pose(config.machine, joints, recording.lidar.mount));
    done("scan view");
    visibility.run(map, map.subset_H(), T_W_H, views, filter.sensors(), visible);
    done("visibility");
    static_cast<void>(integrity.run(map, visible, T_W_H, views));
    static_cast<void>(integrity.step(Eigen::Vector3d::Zero()));
    done("integrity");
    const KdTree tree(filtered.hull_W, TreeUse::one_batch);
    done("scan tree");
    measured_W.clear();
    for (const VisiblePoint& point : visible) {
      measured_W.push_back((T_W_H * map.subset_H()[point.index].cast<double>()).cast<float>());
    }
    nearest.resize(measured_W.size());
    tree.nearest(measured_W, std::numeric_limits<float>::infinity(), nearest);
    done("metrics");
  });
}

void print(const std::map<std::string, double>& figures) {
  const char* separator = "{";
  for (const auto& [name, value] : figures) {
    std::printf("%s\"%s\": %.3f", separator, name.c_str(), value);
    separator = ", ";
  }
  std::printf("}\n");
}

void run() {
  const FrameRecording recording = record_frames(kFrames, kSeed);
  const std::filesystem::path map_file = write_map();
  Stopwatch watch;
  Result<MapFile> read = read_map_file(map_file);
  const double reading = watch.lap();
  std::filesystem::remove(map_file);
  require(static_cast<bool>(read), "the map cannot be read");
  const auto map = std::make_shared<const HullMap>(std::move(read->cloud));
  const double preparing = watch.lap();

  Figures figures;
  for (int round = 0; round < kRounds; ++round) {
    time_frames(recording, map, figures);
  }
  const double memory = peak_memory_mb();
  time_parts(recording, *map, figures);

  std::map<std::string, double> out = {
      {"frame_median_ms", percentile(figures.frame, 0.5)},
      {"frame_p99_ms", percentile(figures.frame, 0.99)},
      {"frames", static_cast<double>(figures.frame.size())},
      {"points", figures.points / static_cast<double>(figures.frame.size())},
      {"clutter_percent", 100.0 * recording.clutter},
      {"map_points", static_cast<double>(map->cloud_H().size())},
      {"map_read_ms", reading},
      {"map_prepare_ms", preparing},
      {"peak_rss_mb", memory},
  };
  for (const auto& [part, times] : figures.parts) {
    out["part " + part] = percentile(times, 0.5);
  }
  print(out);
}

}  // namespace
}  // namespace hulltrack::bench

int main() { hulltrack::bench::run(); }
