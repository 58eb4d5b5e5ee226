// Does the scan contradict the pose? Checks that do not trust the registration's own figures.
//
// A point-to-point registration slides along surfaces: its residual, its matched points and Q1 hardly
// change while it is off by decimetres along the quay. So every visible flat map point (surfel) is asked
// along the sensor's own rays: the ray that would meet its plane nearest to it, where did it really end?
//   confirmed     on the plane, within kPlaneGate
//   contradicted  off the plane; behind it by more than kBehind: seen through
//   hidden        in front of it by more than kBehind, or by less where the map has something: says nothing
// From these come the share of confirmed surfels for each class of surfaces, the share seen through, and a
// robust plane-to-point least squares step: by how much is the pose off, and how sure is that?
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
#include "core/integrity/patch_evidence.hpp"
#include "core/map/hull_map.hpp"
#include "core/registration/bend.hpp"
#include "core/sight/scan_view.hpp"
#include "core/sight/surface_rays.hpp"
#include "core/sight/visibility.hpp"

namespace hulltrack {

/// Surfels of one class that a ray reached or should have.
struct SurfaceCount {
  std::uint32_t expected = 0;  // confirmed + contradicted
  std::uint32_t confirmed = 0;
  [[nodiscard]] double share() const { return expected == 0 ? 0.0 : double(confirmed) / double(expected); }
};

/// One surfel and what the rays around it found.
struct SurfelObservation {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  // where the pose puts the surfel
  Eigen::Vector3d n_W = Eigen::Vector3d::Zero();  // its normal
  double offset = 0.0;  // n . (return - p), m, mean: how far the surface really is along the normal
  double weight = 1.0;  // independent returns that the mean is worth
};

/// A least squares step of observations: the pose's remaining error as the scan sees it.
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
  std::uint32_t expected = 0;  // all classes and none
  std::uint32_t confirmed = 0;
  std::uint32_t seen_through = 0;  // part of the contradicted
  PlaneStep step;
  PatchReport patches;
};

struct IntegrityFinding {
  Faults faults = 0;       // contradicted, unconstrained
  std::string reason;      // with figures; empty without a fault
  bool undecided = false;  // too early to say whether it is the ship of the map
};

/// Robust (Geman-McClure) Gauss-Newton over fixed observations, linearised about their centroid; the answer
/// speaks of `reference_W`. sigma^2 H^-1 is inflated by kInflation^2.
[[nodiscard]] PlaneStep solve_plane_step(std::span<const SurfelObservation> observations,
                                         const Eigen::Vector3d& reference_W);

/// What the figures mean for health; the limits and where they come from stand in the source.
[[nodiscard]] IntegrityFinding judge_integrity(const IntegrityReport& report);

/// The same without the patches: may they be judged at this pose?
[[nodiscard]] IntegrityFinding judge_pose_integrity(const IntegrityReport& report);

/// May the hull as well lie at another place, whose report is `there`, if the scan confirms `here` surfels at
/// the frame's own pose?
[[nodiscard]] bool is_alternative(const IntegrityReport& there, std::uint32_t here);

class Integrity {
 public:
  static constexpr float kPlaneGate = 0.15F;  // m
  static constexpr float kBehind = surface_rays::kBehind;
  /// Surfaces are looked at as far as this from the sensor, m: with lasers 2 deg apart the lines of a scan
  /// lie 1.4 m apart there, and every fourth surfel still meets a ray.
  static constexpr double kSight = 40.0;

  /// `visible`: of map.probes_H(), at the pose T_W_H. Neither the step nor the patches are in the report yet.
  [[nodiscard]] IntegrityReport run(const HullMap& map, std::span<const VisiblePoint> visible,
                                    const Pose& T_W_H, std::span<const ScanView> views);

  /// The step that the scan of the last run() asks for. `reference_W`: the hull's reference point at its
  /// pose.
  [[nodiscard]] PlaneStep step(const Eigen::Vector3d& reference_W) const {
    return solve_plane_step(observations_, reference_W);
  }

  /// What the scan of the last run() says about the ship, at its pose but for report.step and bent by `bend`
  /// (m) along `shape`; fills report.patches. Once a frame, for the frame's own pose. What was seen belongs
  /// to one unbroken track: it is put elsewhere when the pose jumps, and forgotten when it comes back from a
  /// gap, or from metres away, at another place, or after minutes out of sight at any.
  void weigh(const HullMap& map, MeasurementTime time, const Pose& T_W_H, const Eigen::Vector3d& reference_W,
             const BendShape& shape, double bend, IntegrityReport& report);

  /// Another ship may lie there from now on.
  void forget() {
    evidence_.reset({});
    weighed_.reset();
  }

 private:
  /// What one probe says about its patch, before the pose's remaining error is taken off.
  struct PatchLook {
    std::uint32_t patch;
    SurfelObservation seen;  // of a ray that went through the normal alone
    enum Kind : std::uint8_t { on, through, goes_on, ends } kind;
  };
  /// A ray that meets the top of a coaming or the air beside it.
  struct RimRay {
    const RimPoint* rim;
    float s;  // across the strip, m: of the return if it is on the top, else of where the plane is met
    float offset;
    bool through;
  };
  void follow_pose(const HullMap& map, MeasurementTime time, const Pose& T_W_H,
                   const Eigen::Vector3d& reference_W);
  void look_at_surfel(const HullMap& map, const VisiblePoint& point, const Pose& T_W_H, const ScanView& view,
                      IntegrityReport& report);
  void look_at_rim(const RimPoint& rim, const VisiblePoint& point, const Pose& T_W_H, const ScanView& view);
  /// Where the scan has the point of the ship that the map and T_W_H put at p_W, less p_W.
  struct Shift {
    Pose T_W_H;
    Eigen::Vector3d reference_W, translation, rotation;
    BendShape shape;
    double bend;
    [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& p_W) const;
  };
  void collect_evidence(const Shift& shift, const Eigen::Matrix3d& covariance_translation);

  std::vector<SurfelObservation> observations_;
  std::vector<RayEnd> rays_;
  std::vector<PatchLook> looks_;
  std::vector<RimRay> rim_rays_;
  PatchEvidence evidence_;
  struct Place {
    MeasurementTime time;
    Eigen::Vector3d reference_W;
  };
  std::optional<Place> weighed_;  // where evidence was collected last
};

}  // namespace hulltrack
