#include "core/tracking/hull_tracker.hpp"

#include <algorithm>
#include <cassert>

#include "core/base/text.hpp"
#include "core/geometry/box.hpp"
#include "core/localisation/pose_covariance.hpp"
#include "core/localisation/pose_finder.hpp"
#include "core/sight/scan_view.hpp"
#include "core/tracking/examiner.hpp"
#include "core/tracking/health.hpp"
#include "core/witness/joint_motion.hpp"
#include "core/witness/machine_witness.hpp"

namespace hulltrack {
namespace {

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
  Examiner examiner;
  MachineWitness machine_witness;
  JointMotionWitness joint_motion;
  HealthMemory memory;
  MotionGauge motion;

  // Buffers of one frame, kept for their capacity.
  FilteredScan filtered;
  std::vector<ScanView> views;

  Impl(const TrackerConfig& c, const MachineConfig& machine, std::vector<SensorConfig> sensors,
       std::shared_ptr<const HullMap> m, std::shared_ptr<const QuayMap> quay)
      : config(c),
        limits(health_limits(c, half_length(m.get()))),
        map(std::move(m)),
        scan_filter(machine, std::move(sensors), c.hull.region),
        finder(c.hull, c.registration, *map),
        examiner(c, map),
        machine_witness(c.quay, std::move(quay), machine, c.hull.region, berth_of(*map, c.hull)),
        joint_motion(machine),
        motion(bounding_box(map->cloud_H())),
        views(scan_filter.sensors().size()) {}

  TrackResult process(const Scan& scan, const JointHistory& joints, const FrameInputs& inputs);
  void forget();
  [[nodiscard]] FrameFindings begin(const Scan& scan, const JointHistory& joints,
                                    const FrameInputs& inputs) const;
  [[nodiscard]] HullDrift drift() const;
  [[nodiscard]] Registration registration_of(const PlaneIcpResult& fit) const;
  void rebuild_views(const Joints& joints_mid);
  [[nodiscard]] MachineStand stand(const JointHistory& joints, MeasurementTime time) const;
  [[nodiscard]] SeenScan seen() const { return {filtered, views, scan_filter.sensors()}; }
  [[nodiscard]] std::optional<Matrix6> covariance_of(const FrameFindings& findings, const PlaneIcpResult& fit,
                                                     const JointHistory& joints) const;
  [[nodiscard]] SearchProgress search(const FrameFindings& findings);
  [[nodiscard]] MachineFinding follow_joints(const FrameFindings& findings, const MachineStand& stand);
};

TrackResult HullTracker::Impl::process(const Scan& scan, const JointHistory& joints,
                                       const FrameInputs& inputs) {
  if (inputs.reacquire) {
    forget();
  }
  FrameFindings findings = begin(scan, joints, inputs);
  if (findings.may_register()) {
    scan_filter.run(scan, joints, drift(), filtered);
    const PlaneIcpResult fit = finder.find(filtered.hull_W, findings.time, memory.track);
    findings.registration = registration_of(fit);
    rebuild_views(joints.at(findings.time).joints);
    const MachineStand machine = stand(joints, findings.time);
    findings.machine =
        machine_witness.look(findings.time, filtered, views, machine, findings.joints_on_trial);
    if (findings.registration.found) {
      findings.examination =
          examiner.examine(findings.registration.pose, findings.time, seen(),
                           covariance_of(findings, fit, joints), finder.bend_shape(), finder.bend());
    }
    findings.search = search(findings);
    if (findings.registration.found && !findings.joints_on_trial && !findings.contradicted()) {
      finder.learn(findings.time, fit);
      findings.machine = follow_joints(findings, machine);
    }
  }
  auto [next, verdict] = judge_health(limits, std::move(memory), findings);
  memory = std::move(next);
  TrackResult result = track_result(findings, std::move(verdict));
  result.frame = scan.frame_number;
  result.found_top = findings.may_register() ? machine_witness.found_top() : std::nullopt;
  result.motion = motion.update(result.time, result.health, result.pose);
  return result;
}

/// A person has checked the joints, and another ship may lie there.
void HullTracker::Impl::forget() {
  examiner.forget();
  machine_witness.forget();
  joint_motion.forget();
}

/// What inputs and joints say of the frame before it is looked at.
FrameFindings HullTracker::Impl::begin(const Scan& scan, const JointHistory& joints,
                                       const FrameInputs& inputs) const {
  FrameFindings findings;
  findings.time = scan.mid_time();
  findings.hold = inputs.hold;
  findings.reacquire = inputs.reacquire;
  findings.standing = inputs.standing;
  findings.joint_trouble = inputs.joint_trouble;
  const bool empty = scan.segments.empty();
  const MeasurementTime first = empty ? findings.time : scan.first_firing;
  const MeasurementTime last = empty ? findings.time : scan.last_firing;
  // The pose is that of the middle of the scan, so the joints must answer there too.
  findings.bracketed = joints.at(findings.time).lookup == JointHistory::Lookup::ok &&
                       (empty || joints.covers(first, last) == JointHistory::Lookup::ok);
  findings.joints_on_trial = findings.bracketed && joints.on_trial(first, last);
  return findings;
}

/// Speed and rate of turn of the hull about its reference point, by its last poses; zero if unknown.
HullDrift HullTracker::Impl::drift() const {
  const auto speed = memory.track.speed_record.speed();
  if (!speed || !memory.track.followed) {
    return {};
  }
  return {memory.track.followed->pose.reference_W(), speed->velocity, speed->rpy_rate};
}

Registration HullTracker::Impl::registration_of(const PlaneIcpResult& fit) const {
  const IcpResult& icp = fit.icp;
  Registration registration;
  registration.found = icp.stop == IcpStop::converged || icp.stop == IcpStop::iteration_limit;
  registration.converged = icp.converged;
  registration.iterations = icp.iterations;
  registration.matched = icp.matched;
  registration.trouble =
      format_text("registration of %zu points: %s", finder.thinned_W().size(), describe(icp.stop));
  if (registration.found) {
    registration.pose = {icp.T_target_source.inverse(), config.hull.reference_point};
  }
  return registration;
}

void HullTracker::Impl::rebuild_views(const Joints& joints_mid) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Pose T_W_L = lidar_pose(scan_filter.machine(), joints_mid, scan_filter.sensors()[i].mount);
    views[i].rebuild(filtered.returns_W[i], T_W_L);
  }
}

/// Joints, their rates and the mean position of the LiDARs at `time`. Call after rebuild_views(); `joints`
/// must have an answer at `time`.
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

/// Of the pose's error at the reference point: that of the fit and that of the joints. Nothing if the fit's
/// is not valid or a direction is free.
std::optional<Matrix6> HullTracker::Impl::covariance_of(const FrameFindings& findings,
                                                        const PlaneIcpResult& fit,
                                                        const JointHistory& joints) const {
  if (!fit.covariance.valid || fit.icp.free_directions != 0) {
    return std::nullopt;
  }
  const HullPose& pose = findings.registration.pose;
  return covariance_at_reference(finder.covariance(fit.covariance), fit.icp.centre, pose.reference_H,
                                 pose.rotation()) +
         covariance_of_joints(scan_filter.machine(), joints, findings.time, pose.reference_W());
}

/// Does another place explain the scan as well? Another place is examined in the same way as the frame's
/// pose.
SearchProgress HullTracker::Impl::search(const FrameFindings& findings) {
  std::optional<PoseFinder::Answer> answer;
  if (findings.registration.found) {
    answer = {findings.registration.pose.T_W_H.inverse(), findings.contradicted()};
  }
  return finder.search(memory.track, answer, [&](const Pose& T_H_W) {
    return !is_alternative(examiner.report_at(T_H_W.inverse(), seen()), findings.examination.confirmed);
  });
}

/// Learns whether the hull seems to move with a joint. That contradicts the machine only if the quay has
/// neither contradicted nor confirmed it in this frame.
MachineFinding HullTracker::Impl::follow_joints(const FrameFindings& findings, const MachineStand& stand) {
  const HullPose& pose = findings.registration.pose;
  joint_motion.add(findings.time, stand, pose.reference_W(), pose.rotation());
  MachineFinding finding = findings.machine;
  if (finding.faults == 0 && !finding.confirmed) {
    finding.reason = joint_motion.contradiction();
    finding.faults = finding.reason.empty() ? Faults{0} : fault::plc_value;
  }
  return finding;
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
