// Does the scan contradict the pose, and is it the ship of the map? Checks that do not trust the
// registration's own figures.
//
// A point-to-point registration slides along surfaces: its residual, its matched points and Q1 hardly change
// while it is off by decimetres along the quay. So the map's surfaces are checked along the sensor's own rays
// (pose_observations.hpp). Output: the share of confirmed surfels of each class of surfaces, the share seen
// through, and a step: the correction of the pose that the scan asks for, by robust least squares, with its
// covariance. Nobody applies the step; it is judged. Integrity collects over seconds what rays say of the
// map's landmarks. The answers can only take health away. Frames W, H; metres, radians.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "core/geometry/hull_pose.hpp"
#include "core/integrity/landmark_memory.hpp"
#include "core/integrity/pose_observations.hpp"
#include "core/map/hull_map.hpp"
#include "core/registration/bend.hpp"

namespace hulltrack {

/// The correction of the pose that brings the observed surfaces onto the map's: the pose's remaining error.
struct PlaneStep {
  bool solved = false;                                    // false: too few observations, or a direction free
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // of the reference point, W, m
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     // rad
  Eigen::Matrix3d covariance_translation = Eigen::Matrix3d::Zero();  // of the reference point
  Eigen::Matrix3d covariance_rotation = Eigen::Matrix3d::Zero();
  [[nodiscard]] bool is_finite() const {
    return translation.allFinite() && rotation.allFinite() && covariance_translation.allFinite() &&
           covariance_rotation.allFinite();
  }
};

struct IntegrityReport : SurfelCounts {
  PlaneStep step;
  LandmarkReport landmarks;
};

struct IntegrityFinding {
  Faults faults = 0;       // contradicted, unconstrained
  std::string reason;      // with figures; empty without a fault
  bool undecided = false;  // no fault, but too few landmarks are judged to say whether it is the map's ship
};

/// Robust (Geman-McClure) Gauss-Newton, linearised about the observations' centroid: the observations stay
/// the same, their weights change. The answer is about `reference_W`. Its covariance is sigma^2 H^-1 times
/// kInflation^2.
[[nodiscard]] PlaneStep solve_plane_step(std::span<const SurfelObservation> observations,
                                         const Eigen::Vector3d& reference_W);

/// What the figures mean for health. The limits and their reasons are in integrity_limits.cpp.
[[nodiscard]] IntegrityFinding judge_integrity(const IntegrityReport& report);

/// The same without the landmarks: they may be judged only at a pose that this does not contradict.
[[nodiscard]] IntegrityFinding judge_pose_integrity(const IntegrityReport& report);

/// May the hull as well lie at another place? `there`: the report at that place; `here`: how many surfels the
/// scan confirms at the frame's own pose.
[[nodiscard]] bool is_alternative(const IntegrityReport& there, std::uint32_t here);

/// Remembers the landmarks that frames have shown. Thread rule: one owner.
class Integrity {
 public:
  /// Adds what a scan shows at the frame's own pose to the memory of the landmarks. Call it once a frame.
  /// What `step` and a bend of `bend` (m) along `shape` explain is taken off. If the pose has jumped since
  /// the last call, what was seen earlier counts as seen elsewhere by the jump. It is forgotten after a jump
  /// that is long or follows a gap, and after minutes out of sight. A pose that the scan contradicts adds
  /// nothing.
  [[nodiscard]] LandmarkReport weigh(const HullMap& map, MeasurementTime time, const HullPose& pose,
                                     const BendShape& shape, double bend, const PoseObservations& seen,
                                     const PlaneStep& step);

  /// Forgets what was seen of the landmarks: another ship may lie there from now on.
  void forget() {
    landmarks_.reset({});
    weighed_.reset();
  }

 private:
  void follow_pose(const HullMap& map, MeasurementTime time, const HullPose& pose);

  LandmarkMemory landmarks_;
  struct Place {
    MeasurementTime time;
    Eigen::Vector3d reference_W;
  };
  std::optional<Place> weighed_;  // when and where landmarks were observed last
};

}  // namespace hulltrack
