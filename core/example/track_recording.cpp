// Where is the hull in each frame of a recording? The library in one page: track_recording FOLDER.
//
// FOLDER holds lidar.pcap, plc.csv and hull.pcd, as `hulltrack record` and `hulltrack simulate` write them.
// Machine and LiDAR are those of the simulator's default berth: put yours in their place. Unlike the service
// this takes every joint value as the PLC gives it. Exit 0 if there was a frame.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/io/map_file.hpp"
#include "core/io/plc_csv.hpp"
#include "core/tracking/hull_tracker.hpp"
#include "lidar_drivers/pcap_source.hpp"
#include "lidar_drivers/scan_builder.hpp"

using namespace hulltrack;

namespace {

int fail(const std::string& reason) {
  std::fprintf(stderr, "track_recording: %s\n", reason.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  LidarConfig lidar;
  lidar.model = "velodyne_vlp16";
  lidar.mount = pose_from_xyz_rpy_deg({18.4, 1.9, -1.6}, {180.0, 75.0, 150.0});

  Result<MapFile> map = read_map_file(folder / "hull.pcd");
  if (!map) return fail(map.error().message);
  const Result<std::vector<PlcCsvRow>> rows = read_plc_csv(folder / "plc.csv");
  if (!rows) return fail(rows.error().message);
  Result<PcapSource> capture = PcapSource::open(folder / "lidar.pcap", {.port = lidar.port, .source_ip = {}});
  if (!capture) return fail(capture.error().message);
  Result<ScanBuilder> scans = ScanBuilder::create({lidar}, FramingConfig{});
  if (!scans) return fail(scans.error().message);

  MachineConfig machine;
  machine.slew = pose_from_xyz_rpy_deg({0.0, -8.0, 17.0}, {0.0, 0.0, 0.0});
  machine.luff = pose_from_xyz_rpy_deg({2.0, 0.0, 3.5}, {0.0, 0.0, 0.0});
  TrackerConfig config;
  config.hull.region =
      Box{{-95.0F, 0.6F, -10.0F}, {95.0F, 45.0F, 25.0F}};  // m, W: what is beside it is no hull
  HullTracker tracker(config, machine, {{lidar.mount, lidar.min_range, lidar.max_range, {}}},
                      std::make_shared<const HullMap>(std::move(map->cloud)));

  JointHistory joints(rows->size() + 2);
  for (const PlcCsvRow& row : *rows) {
    joints.add(
        {measurement_time_from_ns(row.t_ns), {row.d_x, radians(row.theta_r_deg), radians(row.theta_p_deg)}});
  }
  int frames = 0;
  const auto track = [&] {
    for (Scan scan; scans->take(scan);) {
      const TrackResult hull = tracker.process(scan, joints, FrameInputs{});
      const Eigen::Vector3d moved = hull.pose.displacement();
      ++frames;
      std::printf("frame %u: health %d, moved by %.3f %.3f %.3f m  %s\n", hull.frame, hull.health ? 1 : 0,
                  moved.x(), moved.y(), moved.z(), hull.reason.c_str());
    }
  };
  for (Datagram datagram;;) {
    const Result<bool> more = capture->next(datagram);
    if (!more) return fail(more.error().message);
    if (!*more) break;
    (void)scans->add(0, datagram);
    track();
  }
  scans->finish();
  track();
  return frames > 0 ? 0 : fail("no frame in " + (folder / "lidar.pcap").string());
}
