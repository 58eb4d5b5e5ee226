#include "core/tracking/track_result.hpp"

#include <utility>

#include "core/localisation/pose_covariance.hpp"

namespace hulltrack {
namespace {

/// 1-sigma along the largest principal axis of covariance + step * step^T. `step` is the correction that the
/// scan asks for; it is not applied, so it counts as error.
double sigma_of(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& step) {
  return largest_sigma(covariance + step * step.transpose());
}

}  // namespace

TrackResult track_result(const FrameFindings& findings, HealthVerdict verdict) {
  TrackResult result;
  result.time = findings.time;
  const Registration& registration = findings.registration;
  result.registered = registration.found;
  result.pose = registration.pose;
  result.converged = registration.converged;
  result.iterations = registration.iterations;
  result.matched = registration.matched;
  if (registration.found) {
    const Examination& examination = findings.examination;
    const PlaneStep& step = examination.step;
    if (step.solved) {
      result.sigma_translation = sigma_of(step.covariance_translation, step.translation);
      result.sigma_rotation = sigma_of(step.covariance_rotation, step.rotation);
    }
    result.covariance = examination.covariance;
    result.metrics = examination.metrics;
    result.bend = examination.bend.d;
    result.sigma_bend = examination.bend.sigma;
  }
  result.state = verdict.state;
  result.health = verdict.state == State::tracking;
  result.faults = verdict.faults;
  result.reason = std::move(verdict.reason);
  result.joints_confirmed = findings.machine.confirmed;
  result.joint_doubts = findings.machine.joints;
  return result;
}

}  // namespace hulltrack
