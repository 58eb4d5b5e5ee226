#include "core/tracking/hull_tracker.hpp"

#include <algorithm>
#include <cassert>

#include "core/base/text.hpp"
#include "core/geometry/box.hpp"
#include "core/integrity/integrity.hpp"
#include "core/localisation/pose_covariance.hpp"
#include "core/localisation/pose_finder.hpp"
#include "core/sight/expected_distance.hpp"
#include "core/sight/nearest_returns.hpp"
#include "core/sight/scan_view.hpp"
#include "core/sight/visibility.hpp"
#include "core/tracking/health.hpp"
#include "core/witness/joint_motion.hpp"
#include "core/witness/machine_witness.hpp"

namespace hulltrack {
namespace {

/// 1-sigma along the largest principal axis of covariance + step * step^T. `step` is the correction that the
/// scan asks for; it is not applied, so it counts as error.
double sigma_of(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& step) {
  return largest_sigma(covariance + step * step.transpose());
}

/// Half of the longer horizontal side of the map's box, m: the lever of the hull's ends when she turns.
double half_length(const HullMap* map) {
  assert(map != nullptr);
  const Box box = bounding_box(map->cloud_H());
  return static_cast<double>((box.max - box.min).head<2>().maxCoeff()) / 2.0;
}

/// Where the hull may lie, W: the map's box, widened by the displacements of hull.envelope.
Box berth_of(const HullMap& map, const HullConfig& hull) {
  const Box box = bounding_box(map.cloud_H());
  return {box.min + hull.envelope.min, box.max + hull.envelope.max};
}

}  // namespace

struct HullTracker::Impl {
  TrackerConfig config;
  HealthLimits limits;
  std::shared_ptr<const HullMap> map;
  ScanFilter scan_filter;
  PoseFinder finder;
  Visibility visibility;
  Integrity integrity;
  MachineWitness machine_witness;
  JointMotionWitness joint_motion;
  ExpectedDistance expected_distance;
  HealthMemory memory;
  MotionGauge motion;

  // Buffers of one frame, kept for their capacity.
  FilteredScan filtered;
  std::vector<ScanView> views;
  std::vector<VisiblePoint> visible;
  Cloud measured_W;  // the metrics' map points
  NearestReturns nearest_returns;
  std::vector<double> distances;  // from each of measured_W to its nearest return, m

  Impl(const TrackerConfig& c, const MachineConfig& machine, std::vector<SensorConfig> sensors,
       std::shared_ptr<const HullMap> m, std::shared_ptr<const QuayMap> quay)
      : config(c),
        limits(health_limits(c, half_length(m.get()))),
        map(std::move(m)),
        scan_filter(machine, std::move(sensors), c.hull.region),
        finder(c.hull, c.registration, *map),
        visibility(std::max(Integrity::kSight, c.health.metric_range)),
        machine_witness(c.quay, std::move(quay), machine, c.hull.region, berth_of(*map, c.hull)),
        joint_motion(machine),
        motion(bounding_box(map->cloud_H())),
        views(scan_filter.sensors().size()) {}

  TrackResult process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs);
  [[nodiscard]] HullDrift drift() const;
  [[nodiscard]] PlaneIcpResult register_scan(FrameFindings& findings, TrackResult& result);
  [[nodiscard]] PlaneStep certainty_of(const PlaneIcpResult& found, const JointHistory& joints,
                                       TrackResult& result) const;
  void look(const Joints& joints_mid);
  void follow_joints(const MachineStand& standing, const TrackResult& result, MachineFinding& finding);
  [[nodiscard]] MachineStand stand(const JointHistory& joints, MeasurementTime time) const;
  DistanceMetrics measure(const Pose& T_W_H);
  IntegrityReport inspect(const Pose& T_W_H);
  /// Returns how many surfels the scan confirms at the pose.
  std::uint32_t examine(const PlaneIcpResult& found, const JointHistory& joints, FrameFindings& findings,
                        TrackResult& result);
  void search(FrameFindings& findings, const TrackResult& result, std::uint32_t confirmed);
};

TrackResult HullTracker::Impl::process(const Scan& scan, const JointHistory& joints,
                                       const FrameInputs& inputs) {
  TrackResult result;
  result.frame = scan.frame_number;
  result.time = scan.mid_time();

  FrameFindings findings;
  findings.time = result.time;
  findings.hold = inputs.hold;
  findings.reacquire = inputs.reacquire;
  findings.standing = inputs.standing;
  findings.joint_trouble = inputs.joint_trouble;
  if (inputs.reacquire) {
    integrity.forget();
    machine_witness.forget();
    joint_motion.forget();
  }
  // The pose is that of the middle of the scan, so the joints must answer there too.
  const JointHistory::Answer mid = joints.at(result.time);
  findings.bracketed = mid.lookup == JointHistory::Lookup::ok &&
                       (scan.segments.empty() ||
                        joints.covers(scan.first_firing, scan.last_firing) == JointHistory::Lookup::ok);
  findings.joints_on_trial =
      findings.bracketed && joints.on_trial(scan.segments.empty() ? result.time : scan.first_firing,
                                            scan.segments.empty() ? result.time : scan.last_firing);
  if (findings.bracketed && !inputs.hold && (inputs.standing & fault::plc_stale) == 0) {
    scan_filter.run(scan, joints, drift(), filtered);
    const PlaneIcpResult found = register_scan(findings, result);
    look(mid.joints);
    const MachineStand standing = stand(joints, result.time);
    findings.machine = machine_witness.look(result.time, filtered, views, standing, findings.joints_on_trial);
    result.joints_confirmed = findings.machine.confirmed;
    result.found_top = machine_witness.found_top();
    result.joint_doubts = findings.machine.joints;
    const std::uint32_t confirmed = result.registered ? examine(found, joints, findings, result) : 0;
    search(findings, result, confirmed);
    if (result.registered && !findings.joints_on_trial &&
        (findings.integrity.faults & fault::contradicted) == 0) {
      finder.learn(result.time, found);
      follow_joints(standing, result, findings.machine);
    }
  }
  auto [next, verdict] = judge_health(limits, std::move(memory), findings);
  memory = std::move(next);
  finder.judged(memory.track, inputs.reacquire);
  result.state = verdict.state;
  result.health = verdict.state == State::tracking;
  result.faults = verdict.faults;
  result.reason = std::move(verdict.reason);
  result.motion = motion.update(result.time, result.health, result.displacement, result.rpy, result.T_W_H);
  return result;
}

PlaneIcpResult HullTracker::Impl::register_scan(FrameFindings& findings, TrackResult& result) {
  PlaneIcpResult answer = finder.find(filtered.hull_W, result.time, memory.track);
  const IcpResult& icp_result = answer.icp;
  const bool found = icp_result.stop == IcpStop::converged || icp_result.stop == IcpStop::iteration_limit;
  result.registered = found;
  result.converged = icp_result.converged;
  result.iterations = icp_result.iterations;
  result.matched = icp_result.matched;
  findings.registered = found;
  findings.converged = icp_result.converged;
  findings.matched = icp_result.matched;
  findings.trouble =
      format_text("registration of %zu points: %s", finder.thinned_W().size(), describe(icp_result.stop));
  if (found) {
    result.T_W_H = icp_result.T_target_source.inverse();
  }
  return answer;
}

/// Speed and rate of turn of the hull about its reference point, by its last poses; zero if unknown.
HullDrift HullTracker::Impl::drift() const {
  const auto speed = memory.track.speed_record.speed();
  if (!speed || !memory.track.followed) {
    return {};
  }
  return {config.hull.reference_point + memory.track.followed->displacement, speed->velocity,
          speed->rpy_rate};
}

/// The step of a point-to-plane fit: zero, since nothing is left to correct, with the covariance of the fit
/// and of the joints. solved is false if the fit's covariance is not valid or a direction is free.
PlaneStep HullTracker::Impl::certainty_of(const PlaneIcpResult& found, const JointHistory& joints,
                                          TrackResult& result) const {
  PlaneStep step;
  step.solved = found.covariance.valid && found.icp.free_directions == 0;
  if (step.solved) {
    const Eigen::Vector3d& reference_H = config.hull.reference_point;
    result.covariance =
        covariance_at_reference(finder.covariance(found.covariance), found.icp.centre, reference_H,
                                result.T_W_H.linear()) +
        covariance_of_joints(scan_filter.machine(), joints, result.time, reference_H + result.displacement);
    step.covariance_translation = result.covariance.bottomRightCorner<3, 3>();
    step.covariance_rotation = result.covariance.topLeftCorner<3, 3>();
  }
  return step;
}

std::uint32_t HullTracker::Impl::examine(const PlaneIcpResult& found, const JointHistory& joints,
                                         FrameFindings& findings, TrackResult& result) {
  const Eigen::Vector3d& reference_H = config.hull.reference_point;
  result.displacement = result.T_W_H * reference_H - reference_H;
  result.rpy = rpy_from_rotation(result.T_W_H.linear());
  IntegrityReport report = inspect(result.T_W_H);
  // The checks of inspect() look as far as Integrity::kSight; distances (Q1) are taken up to metric_range.
  keep_within(config.health.metric_range, visible);
  std::optional<double> q1_expected;
  bool few_surfels = false;
  if (config.metrics_scope != MetricsScope::whole_map) {  // the expected Q1 is of visible points
    q1_expected = expected_distance.q1(*map, visible, result.T_W_H, views);
    few_surfels = expected_distance.had_few_surfels();
  }
  result.metrics = measure(result.T_W_H);
  result.metrics.q1_expected = q1_expected;
  result.metrics.few_surfels = few_surfels;

  const Eigen::Vector3d reference_W = reference_H + result.displacement;
  report.step = config.registration.method == RegistrationMethod::automatic
                    ? certainty_of(found, joints, result)
                    : integrity.step(reference_W);
  integrity.weigh(*map, result.time, result.T_W_H, reference_W, finder.bend_shape(), finder.bend().d, report);
  if (report.step.solved) {
    result.sigma_translation = sigma_of(report.step.covariance_translation, report.step.translation);
    result.sigma_rotation = sigma_of(report.step.covariance_rotation, report.step.rotation);
  }
  result.bend = finder.bend().d;
  result.sigma_bend = finder.bend().sigma;
  findings.metrics = result.metrics;
  findings.displacement = result.displacement;
  findings.rotation = result.T_W_H.linear();
  findings.integrity = judge_integrity(report);
  return report.confirmed;
}

/// Finds what should be visible at T_W_H (`visible` is replaced) and asks the scan's rays about each point.
IntegrityReport HullTracker::Impl::inspect(const Pose& T_W_H) {
  visibility.run(*map, map->probes_H(), T_W_H, views, scan_filter.sensors(), visible);
  return integrity.run(*map, visible, T_W_H, views);
}

/// Does another place explain the scan as well? The frame's pose is reported to the search as right or
/// contradicted. Then at most one other place is aligned, checked in the same way and reported.
void HullTracker::Impl::search(FrameFindings& findings, const TrackResult& result, std::uint32_t confirmed) {
  const Pose T_H_W = result.T_W_H.inverse();
  if (result.registered) {
    const bool wrong = (findings.integrity.faults & fault::contradicted) != 0;
    finder.settle(T_H_W, T_H_W, wrong);
    if (const auto rival = wrong ? std::nullopt : finder.rival(T_H_W)) {
      const Pose T_W_H = rival->T_H_W.inverse();
      IntegrityReport report = inspect(T_W_H);
      report.step = integrity.step(T_W_H * config.hull.reference_point);
      finder.settle(rival->start, rival->T_H_W, !is_alternative(report, confirmed));
    }
  }
  findings.search = finder.findings(T_H_W);
}

void HullTracker::Impl::look(const Joints& joints_mid) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Pose T_W_L = lidar_pose(scan_filter.machine(), joints_mid, scan_filter.sensors()[i].mount);
    views[i].rebuild(filtered.returns_W[i], T_W_L);
  }
}

/// Learns whether the hull seems to move with a joint. That contradicts the machine only if the quay has
/// neither contradicted nor confirmed it in this frame.
void HullTracker::Impl::follow_joints(const MachineStand& standing, const TrackResult& result,
                                      MachineFinding& finding) {
  joint_motion.add(result.time, standing, config.hull.reference_point + result.displacement,
                   result.T_W_H.linear());
  if (finding.faults == 0 && !finding.confirmed) {
    finding.reason = joint_motion.contradiction();
    finding.faults = finding.reason.empty() ? Faults{0} : fault::plc_value;
  }
}

/// Joints, their rates and the mean position of the LiDARs at `time`. Call after look(); `joints` must have
/// an answer at `time`.
MachineStand HullTracker::Impl::stand(const JointHistory& joints, MeasurementTime time) const {
  MachineStand stand;
  if (const auto moving = joints.motion_at(time)) {
    stand.joints = moving->joints;
    stand.rate = moving->rate;
  } else {
    stand.joints = joints.at(time).joints;  // a single sample: rates are zero
  }
  for (const ScanView& view : views) {
    stand.sensor_W += view.T_W_L().translation() / static_cast<double>(views.size());
  }
  return stand;
}

DistanceMetrics HullTracker::Impl::measure(const Pose& T_W_H) {
  const Eigen::Matrix3f R = T_W_H.linear().cast<float>();
  const Point t = T_W_H.translation().cast<float>();
  measured_W.clear();
  const auto add = [&](const Point& p_H) { measured_W.push_back(R * p_H + t); };
  const bool full = config.metrics_scope == MetricsScope::visible_full;
  if (config.metrics_scope == MetricsScope::whole_map) {
    std::for_each(map->cloud_H().begin(), map->cloud_H().end(), add);
  } else {
    if (full) {
      visibility.run(*map, map->cloud_H(), T_W_H, views, scan_filter.sensors(), visible);
      keep_within(config.health.metric_range, visible);
    }
    const Cloud& candidates_H = full ? map->cloud_H() : map->subset_H();
    for (const VisiblePoint& point : visible) {
      if (point.index < candidates_H.size()) {  // the rest are rim points
        add(candidates_H[point.index]);
      }
    }
  }
  nearest_returns.run(measured_W, views, filtered, distances);
  return summarise_distances(distances);
}

HullTracker::HullTracker(const TrackerConfig& config, const MachineConfig& machine,
                         std::vector<SensorConfig> sensors, std::shared_ptr<const HullMap> map,
                         std::shared_ptr<const QuayMap> quay)
    : impl_(std::make_unique<Impl>(config, machine, std::move(sensors), std::move(map), std::move(quay))) {}
HullTracker::~HullTracker() = default;
HullTracker::HullTracker(HullTracker&&) noexcept = default;
HullTracker& HullTracker::operator=(HullTracker&&) noexcept = default;

TrackResult HullTracker::process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs) {
  return impl_->process(scan, joints, inputs);
}

}  // namespace hulltrack
