// Does the scan contradict the pose? Checks that do not trust the registration's own figures.
//
// A point-to-point registration slides along surfaces: its residual, its matched points and Q1 hardly
// change while it is off by decimetres along the quay. So every visible flat map point (surfel) is checked
// along the sensor's own rays: the ray that meets its plane nearest to it, where did it really end?
//   confirmed     within kPlaneGate of the plane
//   contradicted  farther off the plane; seen through if more than kBehind behind it
//   hidden        more than kBehind before it, or less if the map has another surface there: not counted
// Output: the share of confirmed surfels of each class of surfaces, the share seen through, and a step: the
// correction of the pose that the scan asks for, by robust least squares, with its covariance. Nobody applies
// the step; it is judged. weigh() also collects what rays say of the map's landmarks: is it the map's ship?
// The answers can only take health away. Frames W, H, L; metres, radians.
// Thread rule: one owner, scratch is kept. Cost: about 0.2 us a visible point.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "core/geometry/se3.hpp"
#include "core/integrity/landmark_memory.hpp"
#include "core/map/hull_map.hpp"
#include "core/registration/bend.hpp"
#include "core/sight/scan_view.hpp"
#include "core/sight/surface_rays.hpp"
#include "core/sight/visibility.hpp"

namespace hulltrack {

/// Surfels of one class of surfaces: how many had a ray that counts, and how many were found in place.
struct SurfaceCount {
  std::uint32_t expected = 0;  // confirmed + contradicted
  std::uint32_t confirmed = 0;
  [[nodiscard]] double share() const { return expected == 0 ? 0.0 : double(confirmed) / double(expected); }
};

/// One surfel and what the rays around it found.
struct SurfelObservation {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  // where the pose puts the surfel
  Eigen::Vector3d n_W = Eigen::Vector3d::Zero();  // its normal
  double offset = 0.0;  // mean of n . (return - p), m: how far the surface really is along the normal
  double weight = 1.0;  // how many independent returns the mean is worth
};

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

struct IntegrityReport {
  std::array<SurfaceCount, kSurfaceClasses> surfaces;
  std::uint32_t expected = 0;  // of all surfels, with a class or without
  std::uint32_t confirmed = 0;
  std::uint32_t seen_through = 0;  // part of those that are not confirmed
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

class Integrity {
 public:
  static constexpr float kPlaneGate = 0.15F;  // m
  static constexpr float kBehind = surface_rays::kBehind;
  /// Surfaces are checked up to this distance from the sensor, m; `visible` has to reach as far. With lasers
  /// 2 deg apart the lines of a scan are 1.4 m apart there, and every fourth surfel still has a ray within
  /// reach.
  static constexpr double kSight = 40.0;

  /// Asks the rays about each visible probe: surfels and rim points (on the tops of coamings). `visible`: of
  /// map.probes_H(), at the pose T_W_H. The report is still without the step and the landmarks.
  [[nodiscard]] IntegrityReport run(const HullMap& map, std::span<const VisiblePoint> visible,
                                    const Pose& T_W_H, std::span<const ScanView> views);

  /// The step that the scan of the last run() asks for. `reference_W`: the hull's reference point at that
  /// pose.
  [[nodiscard]] PlaneStep step(const Eigen::Vector3d& reference_W) const {
    return solve_plane_step(observations_, reference_W);
  }

  /// Adds what the scan of the last run() shows to the memory of the landmarks; fills report.landmarks. Call
  /// it once a frame, for the frame's own pose. What report.step and a bend of `bend` (m) along `shape`
  /// explain is taken off. If the pose has jumped since the last call, what was seen earlier counts as seen
  /// elsewhere by the jump. It is forgotten after a jump that is long or follows a gap, and after minutes
  /// out of sight.
  void weigh(const HullMap& map, MeasurementTime time, const Pose& T_W_H, const Eigen::Vector3d& reference_W,
             const BendShape& shape, double bend, IntegrityReport& report);

  /// Forgets what was seen of the landmarks: another ship may lie there from now on.
  void forget() {
    landmarks_.reset({});
    weighed_.reset();
  }

 private:
  /// What one ray, or one probe, says about a landmark. The pose's remaining error is not yet taken off.
  struct LandmarkObservation {
    std::uint32_t landmark;
    SurfelObservation seen;  // kind on: all of it; through: only the normal; else nothing
    enum Kind : std::uint8_t { on, through, goes_on, ends } kind;  // the last two: over the hold beside a rim
  };
  /// A ray that ended on the top of a coaming, a rim, or went down beside it.
  struct RimRay {
    const RimPoint* rim;
    float s;  // m across the rim: of the return, or if it went down: of where the ray meets the top's plane
    float offset;  // height of the return over the top, m
    bool through;  // it went down
  };
  void follow_pose(const HullMap& map, MeasurementTime time, const Pose& T_W_H,
                   const Eigen::Vector3d& reference_W);
  void observe_surfel(const HullMap& map, const VisiblePoint& point, const Pose& T_W_H, const ScanView& view,
                      IntegrityReport& report);
  void observe_rim(const RimPoint& rim, const VisiblePoint& point, const Pose& T_W_H, const ScanView& view);
  /// How far the scan finds points of the ship from where map and pose put them: the pose's error and bend.
  struct Shift {
    Pose T_W_H;
    Eigen::Vector3d reference_W, translation, rotation;
    BendShape shape;
    double bend;
    [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& p_W) const;
  };
  void observe_landmarks(const Shift& shift, const Eigen::Matrix3d& covariance_translation);

  std::vector<SurfelObservation> observations_;
  std::vector<RayEnd> rays_;
  std::vector<LandmarkObservation> of_landmarks_;
  std::vector<RimRay> rim_rays_;
  LandmarkMemory landmarks_;
  struct Place {
    MeasurementTime time;
    Eigen::Vector3d reference_W;
  };
  std::optional<Place> weighed_;  // when and where landmarks were observed last
};

}  // namespace hulltrack
