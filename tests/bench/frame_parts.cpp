#include "tests/bench/frame_parts.hpp"

#include "core/filter/voxel_filter.hpp"
#include "core/geometry/box.hpp"
#include "core/integrity/integrity.hpp"
#include "core/localisation/pose_covariance.hpp"
#include "core/localisation/pose_finder.hpp"
#include "core/map/surfels.hpp"
#include "core/sight/expected_distance.hpp"
#include "core/sight/nearest_returns.hpp"
#include "core/sight/visibility.hpp"
#include "daemon/config/conversions.hpp"
#include "tests/bench/bench_process.hpp"
#include "tests/bench/stopwatch.hpp"

namespace hulltrack::bench {
namespace {

/// As if the frames so far had shown the hull at T_W_H.
void follow(const Pose& T_W_H, MeasurementTime time, Track& track) {
  const HullPose pose{T_W_H, HullConfig{}.reference_point};
  track.unique = true;
  track.followed = {time, pose};
  track.speed_record.add(time, pose.displacement(), pose.rpy());
}

}  // namespace

void time_frame_parts(const FrameRecording& recording, const HullMap& map, Parts& parts) {
  const Config config = config_for(recording);
  const Eigen::Vector3d& reference_H = config.tracker.hull.reference_point;
  const ScanFilter filter(config.machine, sensor_configs(config.lidars), std::nullopt);
  PoseFinder finder(config.tracker.hull, config.tracker.registration, map);
  PointToPlaneIcp icp({}, finder.bend_shape());
  Visibility visibility(std::max(pose_observations::kSight, config.tracker.health.metric_range));
  Integrity integrity;
  Track track;
  FilteredScan filtered;
  std::vector<ScanView> views(1);
  std::vector<VisiblePoint> visible;
  Cloud measured_W;
  NearestReturns nearest_returns;
  ExpectedDistance expected_distance;
  std::vector<double> distances;
  play(recording, [&](const Scan& scan) {
    const MeasurementTime time = scan.mid_time();
    if (!track.followed) {
      follow(recording.T_W_H, time, track);
    }
    Stopwatch watch;
    const auto done = [&](const char* part) {
      parts[part].push_back(watch.lap().cpu);
      watch.lap();
    };
    filter.run(scan, recording.joints, {}, filtered);
    done("filter");
    const PlaneIcpResult found = finder.find(filtered.hull_W, time, track);
    done("register");
    const PlaneIcpResult again =
        icp.align(finder.thinned_W(), map.planes(), found.icp.T_target_source, finder.bend());
    done("(one alignment from its own answer)");
    require(again.icp.converged, "an alignment does not hold");
    const Pose T_W_H = found.icp.T_target_source.inverse();
    const Joints joints = recording.joints.at(time).joints;
    views[0].rebuild(filtered.returns_W[0], lidar_pose(config.machine, joints, recording.lidar.mount));
    done("scan view");
    visibility.run(map, map.probes_H(), T_W_H, views, filter.sensors(), visible);
    done("visibility");
    const PoseObservations seen = observe_pose(map, visible, T_W_H, views);
    done("integrity");
    keep_within(config.tracker.health.metric_range, visible);
    require(expected_distance.q1(map, visible, T_W_H, views).has_value(), "no expected Q1");
    done("expect");
    measured_W.clear();
    for (const VisiblePoint& point : visible) {
      if (point.index < map.subset_H().size()) {
        measured_W.push_back((T_W_H * map.subset_H()[point.index].cast<double>()).cast<float>());
      }
    }
    nearest_returns.run(measured_W, views, filtered, distances);
    require(summarise_distances(distances).valid, "no metrics");
    done("metrics");
    PlaneStep step;
    step.solved = found.covariance.valid;
    step.covariance_translation = finder.covariance(found.covariance).bottomRightCorner<3, 3>();
    require(integrity
                    .weigh(map, scan.mid_time(), {T_W_H, reference_H}, finder.bend_shape(), finder.bend().d,
                           seen, step)
                    .in_view > 0,
            "no landmark in view");
    done("landmarks");
    (void)finder.search(track, PoseFinder::Answer{found.icp.T_target_source, false},
                        [](const Pose&) { return true; });  // the scan contradicts every other place
    done("challenge");
    follow(T_W_H, time, track);
    finder.learn(time, found);
    done("learn");
  });
}

void time_map_parts(const Cloud& cloud_H, Parts& parts) {
  Stopwatch watch;
  const auto done = [&](const char* part) {
    parts[part].push_back(watch.lap().cpu);
    watch.lap();
  };
  const auto thinned = [&](float voxel) {
    Cloud out;
    VoxelFilter(voxel).filter(cloud_H, out);
    return out;
  };
  const KdTree tree(cloud_H);
  done("tree");
  const Cloud subset_H = thinned(HullMap::kSubsetVoxel);
  done("subset");
  std::vector<Surfel> surfels = compute_surfels(subset_H, tree);
  done("surfels");
  const PointBlocks occluders_H(thinned(HullMap::kOccluderVoxel));
  done("occluders");
  const Relief relief(cloud_H);
  done("relief");
  const PlaneMap planes(cloud_H, tree, relief);
  done("planes");
  const OccupancyGrid occupancy(subset_H);
  done("occupancy");
  surfels = oriented_surfels(subset_H, tree, std::move(surfels));
  done("sides");
  std::vector<RimPoint> rims = find_rims(cloud_H, tree, relief);
  done("rims");
  const std::vector<Landmark> landmarks =
      find_landmarks(subset_H, tree, relief, std::move(surfels), std::move(rims)).landmarks;
  done("landmarks");
  require(!landmarks.empty() && !planes.planes().empty(), "a map without surfaces");
}

}  // namespace hulltrack::bench
