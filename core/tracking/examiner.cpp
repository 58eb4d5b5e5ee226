#include "core/tracking/examiner.hpp"

#include <algorithm>
#include <utility>

namespace hulltrack {

Examiner::Examiner(const TrackerConfig& config, std::shared_ptr<const HullMap> map)
    : config_(config),
      map_(std::move(map)),
      visibility_(std::max(pose_observations::kSight, config.health.metric_range)) {}

Examination Examiner::examine(const HullPose& pose, MeasurementTime time, const SeenScan& scan,
                              const std::optional<Matrix6>& covariance, const BendShape& shape,
                              const Bend& bend) {
  Examination examination;
  const PoseObservations seen = observe(pose.T_W_H, scan);
  // observe() looks as far as kSight; distances (Q1) are taken up to metric_range.
  keep_within(config_.health.metric_range, visible_);
  std::optional<double> q1_expected;
  bool few_surfels = false;
  if (config_.metrics_scope != MetricsScope::whole_map) {  // the expected Q1 is of visible points
    q1_expected = expected_distance_.q1(*map_, visible_, pose.T_W_H, scan.views);
    few_surfels = expected_distance_.had_few_surfels();
  }
  examination.metrics = measure(pose.T_W_H, scan);
  examination.metrics.q1_expected = q1_expected;
  examination.metrics.few_surfels = few_surfels;

  IntegrityReport report{seen.counts, {}, {}};
  if (config_.registration.method != RegistrationMethod::automatic) {
    report.step = solve_plane_step(seen.surfels, pose.reference_W());
  } else if (covariance) {
    report.step.solved = true;
    report.step.covariance_translation = covariance->bottomRightCorner<3, 3>();
    report.step.covariance_rotation = covariance->topLeftCorner<3, 3>();
    examination.covariance = *covariance;
  }
  report.landmarks = integrity_.weigh(*map_, time, pose, shape, bend.d, seen, report.step);
  examination.step = report.step;
  examination.bend = bend;
  examination.confirmed = report.confirmed;
  examination.integrity = judge_integrity(report);
  return examination;
}

IntegrityReport Examiner::report_at(const Pose& T_W_H, const SeenScan& scan) {
  const PoseObservations seen = observe(T_W_H, scan);
  return {seen.counts, solve_plane_step(seen.surfels, T_W_H * config_.hull.reference_point), {}};
}

/// Finds what should be visible at T_W_H (`visible_` is replaced) and asks the scan's rays about each point.
PoseObservations Examiner::observe(const Pose& T_W_H, const SeenScan& scan) {
  visibility_.run(*map_, map_->probes_H(), T_W_H, scan.views, scan.sensors, visible_);
  return observe_pose(*map_, visible_, T_W_H, scan.views);
}

DistanceMetrics Examiner::measure(const Pose& T_W_H, const SeenScan& scan) {
  const Eigen::Matrix3f R = T_W_H.linear().cast<float>();
  const Point t = T_W_H.translation().cast<float>();
  measured_W_.clear();
  const auto add = [&](const Point& p_H) { measured_W_.push_back(R * p_H + t); };
  const bool full = config_.metrics_scope == MetricsScope::visible_full;
  if (config_.metrics_scope == MetricsScope::whole_map) {
    std::for_each(map_->cloud_H().begin(), map_->cloud_H().end(), add);
  } else {
    if (full) {
      visibility_.run(*map_, map_->cloud_H(), T_W_H, scan.views, scan.sensors, visible_);
      keep_within(config_.health.metric_range, visible_);
    }
    const Cloud& candidates_H = full ? map_->cloud_H() : map_->subset_H();
    for (const VisiblePoint& point : visible_) {
      if (point.index < candidates_H.size()) {  // the rest are rim points
        add(candidates_H[point.index]);
      }
    }
  }
  nearest_returns_.run(measured_W_, scan.views, scan.filtered, distances_);
  return summarise_distances(distances_);
}

}  // namespace hulltrack
