#include "core/integrity/integrity.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/localisation/track.hpp"

namespace hulltrack {
namespace {

using surface_rays::kSameSurface;

// A direction in which the pose is less sure tells nothing of landmarks: three times this is a displaced
// landmark.
constexpr double kBlurred = 0.015;  // m, 1 sigma
// After a jump farther than this the landmarks' histograms are of other surfaces: they are forgotten.
constexpr double kOtherPlace = LandmarkMemory::kReach;  // m
// A pose jumps if it moves by kJump more than kFastestHull allows: some three sigma of a pose that is as sure
// as kBlurred. At most kGap counts as time for the hull to move, two frames without landmarks and a margin.
constexpr double kJump = 0.05;  // m
constexpr double kGap = 0.25;   // s
// After a longer time without landmarks they are forgotten: another ship may have moored there.
constexpr double kExchange = 300.0;  // s

/// How far the scan finds points of the ship from where map and pose put them: the pose's error and bend.
struct Shift {
  HullPose pose;
  Eigen::Vector3d translation, rotation;
  BendShape shape;
  double bend;
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& p_W) const;
};

Eigen::Vector3d Shift::at(const Eigen::Vector3d& p_W) const {
  const double x_H = pose.T_W_H.linear().col(0).dot(p_W - pose.T_W_H.translation());
  return translation + rotation.cross(p_W - pose.reference_W()) +
         bend * shape.rise(x_H) * pose.T_W_H.linear().col(2);
}

/// Adds the frame's observations and rim rays to the landmarks, less what `shift` (pose error and bend)
/// explains.
void remember(const PoseObservations& seen, const Shift& shift, const Eigen::Matrix3d& covariance_translation,
              LandmarkMemory& landmarks) {
  const Pose& T_W_H = shift.pose.T_W_H;
  // True if the pose is sure enough along the normal for an offset to say something about the ship.
  const auto sharp = [&](const Eigen::Vector3d& n_W) {
    return n_W.dot(covariance_translation * n_W) < kBlurred * kBlurred;
  };
  const RimPoint* last = nullptr;
  bool used = false;
  float lift = 0.0F;
  float aside = 0.0F;
  for (const RimRay& ray : seen.rim_rays) {
    if (ray.rim != last) {
      last = ray.rim;
      const Eigen::Vector3d moved_H =
          T_W_H.linear().transpose() * shift.at(T_W_H * ray.rim->p_H.cast<double>());
      lift = static_cast<float>(moved_H.z());
      aside = ray.rim->across_H.dot(moved_H.cast<float>());
      used = sharp(T_W_H.linear() * ray.rim->across_H.cast<double>());
    }
    if (!used) {
      continue;
    }
    if (ray.through || std::abs(ray.offset - lift) < kSameSurface) {
      landmarks.add_across(*ray.rim, ray.s - aside, !ray.through);
    }
  }
  for (const LandmarkObservation& observed : seen.landmarks) {
    switch (observed.kind) {
      case LandmarkObservation::on:
        if (!sharp(observed.seen.n_W)) {
          break;
        }
        landmarks.add_offset(observed.landmark,
                             observed.seen.offset - observed.seen.n_W.dot(shift.at(observed.seen.p_W)),
                             observed.seen.weight);
        break;
      case LandmarkObservation::through:
        if (sharp(observed.seen.n_W)) {
          landmarks.add_through(observed.landmark);
        }
        break;
      case LandmarkObservation::goes_on:
      case LandmarkObservation::ends:
        landmarks.add_beside(observed.landmark, observed.kind == LandmarkObservation::goes_on);
        break;
    }
  }
}

}  // namespace

LandmarkReport Integrity::weigh(const HullMap& map, MeasurementTime time, const HullPose& pose,
                                const BendShape& shape, double bend, const PoseObservations& seen,
                                const PlaneStep& step) {
  if (landmarks_.size() != map.landmarks().size()) {
    landmarks_.reset(map.landmarks());
  }
  landmarks_.begin_frame();
  const IntegrityReport report{seen.counts, step, {}};
  if (step.solved && step.is_finite() && (judge_pose_integrity(report).faults & fault::contradicted) == 0) {
    follow_pose(map, time, pose);
    remember(seen, {pose, step.translation, step.rotation, shape, bend}, step.covariance_translation,
             landmarks_);
  }
  return landmarks_.report();
}

/// Compares the pose with that of the last observation. After a long time, or a jump that is long or follows
/// a gap, the landmarks are forgotten; after another jump it counts as seen elsewhere.
void Integrity::follow_pose(const HullMap& map, MeasurementTime time, const HullPose& pose) {
  const Eigen::Vector3d reference_W = pose.reference_W();
  if (weighed_) {
    const double dt = std::max(0.0, to_seconds(time - weighed_->time));
    const Eigen::Vector3d moved_W = reference_W - weighed_->reference_W;
    const double moved = moved_W.norm();
    const bool jumped = moved > kJump + kFastestHull * std::min(dt, kGap);
    if (dt > kExchange || (jumped && (dt > kGap || moved > kOtherPlace))) {
      landmarks_.reset(map.landmarks());
    } else if (jumped) {
      landmarks_.put_elsewhere((pose.T_W_H.linear().transpose() * moved_W).cast<float>());
    }
  }
  weighed_ = {time, reference_W};
}

}  // namespace hulltrack
