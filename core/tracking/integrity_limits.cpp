#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/base/text.hpp"
#include "core/tracking/integrity.hpp"

namespace hulltrack {
namespace {

// What a healthy pose may be off, at most: 10 cm at the reference point and 0.3 deg. A fifth of it is kept
// for what no scan can tell (encoder steps, boom sag, calibration); the rest is for the step that the scan
// asks for plus three sigma of that step.
constexpr double kTranslationBudget = 0.08;
const double kRotationBudget = radians(0.24);
// Three sigma alone may take half of it: else the geometry, not the pose, is to blame.
constexpr double kShareOfSigma = 0.5;

// At a right pose a surfel is missed only beside edges and where something was moved: the simulation in
// which the table of FIELD magnitudes was made confirms .71 to .96 of a class; off by more than kPlaneGate
// it leaves .02 to .17. The limit is in the middle.
constexpr double kLeastShare = 0.5;
constexpr std::uint32_t kFewestForShare = 20;  // 3 sigma of a share of 0.7 from 20 is 0.3

// Seen through: .02 at rest, .07 and more from a metre on.
constexpr double kMostSeenThrough = 0.05;

// Fewer confirmed surfels (16 m^2) are no ground for any statement.
constexpr std::uint32_t kFewestConfirmed = 100;

double largest_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[2]));
}

IntegrityFinding judge_step(const PlaneStep& step) {
  if (!step.solved) {
    return {fault::unconstrained, "the surfaces in view leave a direction free"};
  }
  const double sigma_t = largest_sigma(step.covariance_translation);
  const double sigma_r = largest_sigma(step.covariance_rotation);
  if (3.0 * sigma_t > kShareOfSigma * kTranslationBudget || 3.0 * sigma_r > kShareOfSigma * kRotationBudget) {
    return {fault::unconstrained,
            format_text("the surfaces in view fix the pose to %.3f m and %.3f deg (1 sigma) only", sigma_t,
                        degrees(sigma_r))};
  }
  const Eigen::Vector3d& t = step.translation;
  if (t.norm() + 3.0 * sigma_t > kTranslationBudget) {
    return {fault::contradicted, format_text("the scan says the pose is off by %.3f, %.3f, %.3f m in x, y, z",
                                             t.x(), t.y(), t.z())};
  }
  if (step.rotation.norm() + 3.0 * sigma_r > kRotationBudget) {
    return {fault::contradicted,
            format_text("the scan says the pose is turned by %.3f deg", degrees(step.rotation.norm()))};
  }
  return {};
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

IntegrityFinding judge_integrity(const IntegrityReport& report) {
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

}  // namespace hulltrack
