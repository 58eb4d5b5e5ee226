#include "core/base/text.hpp"
#include "core/geometry/health_contract.hpp"
#include "core/integrity/integrity.hpp"
#include "core/localisation/pose_covariance.hpp"

namespace hulltrack {
namespace {

// The pose is contradicted if the length of the step that the scan asks for (zero after a point-to-plane fit)
// plus so many of its sigmas is beyond the contract, 5 cm or 0.1 deg.
constexpr double kSigmas = 3.0;
// If kSigmas sigmas alone are beyond this share of the contract, the fault is `unconstrained`: the geometry
// is to blame, not the pose. Otherwise four sigma are within the contract: not one healthy frame in ten
// thousand is beyond it.
constexpr double kShareOfSigma = 0.75;

// Least share of confirmed surfels in each class of surfaces; below it the pose is contradicted. At a right
// pose nine in ten and more are confirmed: the others were moved, or noise is large. Of a class that is off
// by more than kPlaneGate less than two in ten are confirmed, by chance. The limit is in the middle.
constexpr double kLeastShare = 0.5;
// Surfels of a class; with fewer its share is not judged. Three sigma of a share of 0.7 are 0.3 with 20.
constexpr std::uint32_t kFewestForShare = 20;

// Largest share of surfels seen through; above it the pose is contradicted. At a pose that is right the share
// was 0.013 at most (1,650 frames of seven recordings of a berth: VLP-16 with draft, shift, rain and moved
// covers, two VLP-16, XT-32), at places one hatch off 0.17 and more.
constexpr double kMostSeenThrough = 0.05;

// With fewer confirmed surfels the pose counts as unconstrained. With 40 a share of 0.9 has a sigma of 5 %.
constexpr std::uint32_t kFewestConfirmed = 40;

// With so many displaced landmarks it is another ship. One thing that was moved on deck shows three faces at
// most. A piece of a coaming's top counts twice, since a coaming cannot be moved; one is not enough, since
// something may lie on it. One coaming's wall that stands behind its place (set back) is enough by itself:
// nothing that is put on board sets it back.
constexpr std::uint32_t kFewestDisplaced = 4;
// If more landmarks are in view, one displaced in so many solid ones (in place or displaced) is needed.
// Perhaps one landmark in a hundred is judged wrongly; a hatch that stands elsewhere is a tenth of the
// landmarks.
constexpr std::uint32_t kSolidPerDisplaced = 20;

// Another place is possible only with this share of the surfels that are confirmed at the frame's own pose.
// If that pose is wrong, it can have more than the right place only by things that came on board and happen
// to be where it expects something fixed: by chance less than two in ten are. If three quarters of the view
// were such things, the right place would have 1 / (1 + 0.2 * 3) as many as the wrong pose.
constexpr double kLeastOfConfirmed = 0.6;

IntegrityFinding judge_step(const PlaneStep& step) {
  if (!step.solved) {
    return {fault::unconstrained, "the surfaces in view leave a direction free"};
  }
  if (!step.is_finite()) {  // NaN is neither above nor below a limit
    return {fault::unconstrained, "the step that the scan asks for is no number"};
  }
  const double sigma_t = largest_sigma(step.covariance_translation);
  const double sigma_r = largest_sigma(step.covariance_rotation);
  if (kSigmas * sigma_t > kShareOfSigma * HealthContract::kPosition ||
      kSigmas * sigma_r > kShareOfSigma * HealthContract::kAttitude) {
    return {fault::unconstrained,
            format_text("the surfaces in view fix the pose to %.3f m and %.3f deg (1 sigma) only", sigma_t,
                        degrees(sigma_r))};
  }
  const Eigen::Vector3d& t = step.translation;
  if (t.norm() + kSigmas * sigma_t > HealthContract::kPosition) {
    return {fault::contradicted, format_text("the scan says the pose is off by %.3f, %.3f, %.3f m in x, y, z",
                                             t.x(), t.y(), t.z())};
  }
  if (step.rotation.norm() + kSigmas * sigma_r > HealthContract::kAttitude) {
    return {fault::contradicted,
            format_text("the scan says the pose is turned by %.3f deg", degrees(step.rotation.norm()))};
  }
  return {};
}

/// Are as many structures displaced as in place, or more? Then either may be where the map's ship has them.
bool outnumbers(const StructureCount& count) {
  return count.displaced > 0 && count.displaced >= count.in_place;
}

IntegrityFinding judge_surfaces(const IntegrityReport& report) {
  for (std::size_t i = 0; i < kSurfaceClasses; ++i) {
    const SurfaceCount& count = report.surfaces[i];
    if (count.expected >= kFewestForShare && count.share() < kLeastShare) {
      return {fault::contradicted, format_text("only %.0f %% of %u %s surfaces are where the pose puts them",
                                               100.0 * count.share(), count.expected,
                                               surface_class_name(static_cast<SurfaceClass>(i)))};
    }
  }
  const double through = double(report.seen_through) / std::max(1.0, double(report.expected));
  if (through > kMostSeenThrough) {
    return {fault::contradicted, format_text("the scan sees through %.0f %% of the hull", 100.0 * through)};
  }
  return {};
}

}  // namespace

IntegrityFinding judge_pose_integrity(const IntegrityReport& report) {
  IntegrityFinding surfaces = judge_surfaces(report);
  IntegrityFinding step =
      report.confirmed < kFewestConfirmed
          ? IntegrityFinding{fault::unconstrained,
                             format_text("only %u map surfaces are confirmed by the scan, %u are needed",
                                         report.confirmed, kFewestConfirmed)}
          : judge_step(report.step);
  surfaces.faults |= step.faults;
  if (surfaces.reason.empty()) {
    surfaces.reason = std::move(step.reason);
  }
  return surfaces;
}

IntegrityFinding judge_integrity(const IntegrityReport& report) {
  IntegrityFinding finding = judge_pose_integrity(report);
  if (finding.faults != 0) {
    return finding;
  }
  const LandmarkReport& landmarks = report.landmarks;
  const std::uint32_t fewest = std::max(kFewestDisplaced, landmarks.solid / kSolidPerDisplaced);
  if (landmarks.set_back > 0 || landmarks.displaced + landmarks.displaced_rims >= fewest) {
    finding.faults = fault::contradicted;
    finding.reason = format_text("another ship than the map's: %u of %u fixed surfaces are elsewhere",
                                 landmarks.displaced, landmarks.solid);
    if (landmarks.median_offset > 0.0) {
      finding.reason += format_text(", by %.2f m", landmarks.median_offset);
    }
  } else if (outnumbers(landmarks.along) || outnumbers(landmarks.across)) {
    const bool along = outnumbers(landmarks.along);
    const StructureCount& count = along ? landmarks.along : landmarks.across;
    finding.faults = fault::contradicted;
    finding.reason =
        format_text("another ship than the map's: %s the ship %u structures stand elsewhere, %u in place",
                    along ? "along" : "across", count.displaced, count.in_place);
  } else if (!landmarks.decided) {
    finding.undecided = true;
    finding.reason = format_text(
        "is it the map's ship? %u of %u surfaces in view are judged; in place are %u structures along the "
        "ship, %u across, %u tops of coamings",
        landmarks.judged, landmarks.in_view, landmarks.along.in_place, landmarks.across.in_place,
        landmarks.rims_in_place);
  }
  return finding;
}

bool is_alternative(const IntegrityReport& there, std::uint32_t here) {
  return (judge_integrity(there).faults & fault::contradicted) == 0 &&
         double(there.confirmed) >= kLeastOfConfirmed * double(here);
}

}  // namespace hulltrack
