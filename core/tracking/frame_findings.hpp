// Everything that one frame says for or against itself: what health is judged by (health.hpp).
//
// Metres, radians. A plain value.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/status.hpp"
#include "core/base/time.hpp"
#include "core/geometry/hull_pose.hpp"
#include "core/integrity/integrity.hpp"
#include "core/localisation/search_progress.hpp"
#include "core/sight/metrics.hpp"
#include "core/witness/machine_finding.hpp"

namespace hulltrack {

/// What registering the scan came to.
struct Registration {
  bool found = false;  // a pose; false: `pose` and the frame's examination mean nothing
  HullPose pose;
  bool converged = false;
  int iterations = 0;
  std::uint32_t matched = 0;  // points of the last ICP iteration
  std::string trouble;        // why there is no pose, or why it did not converge
};

/// How the scan bears out the pose that was found.
struct Examination {
  DistanceMetrics metrics;
  IntegrityFinding integrity;
  std::uint32_t confirmed = 0;  // surfels
  PlaneStep step;
  Bend bend;  // of the hull, as it was known before this frame
  /// Of the pose's error at the reference point, [rotation; translation], W, rad and m. Zero if unknown.
  Matrix6 covariance = Matrix6::Zero();
};

struct FrameFindings {
  MeasurementTime time{};  // middle of the scan
  bool hold = false;
  bool reacquire = false;        // rising edge
  Faults standing = 0;           // faults of the inputs that hold now, as in FrameInputs (hull_tracker.hpp)
  bool bracketed = false;        // joint samples lie before and after every packet
  bool joints_on_trial = false;  // some of these samples are not confirmed yet
  std::string joint_trouble;     // why joint values are refused or on trial
  Registration registration;
  Examination examination;
  MachineFinding machine;
  SearchProgress search;

  /// Whether joints and commands let the scan be registered at all.
  [[nodiscard]] bool may_register() const { return bracketed && !hold && (standing & fault::plc_stale) == 0; }
  [[nodiscard]] bool contradicted() const {
    return (examination.integrity.faults & fault::contradicted) != 0;
  }
};

}  // namespace hulltrack
