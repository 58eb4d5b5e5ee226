// Does the scan bear out a pose of the hull? Distances (Q1), the checks of core/integrity, and how sure the
// pose is.
//
// Frames W, H; metres, radians. No failure. Thread rule: one owner, scratch is kept. Cost: 3 ms a pose, of
// which most is visibility and the distances.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/map/hull_map.hpp"
#include "core/sight/expected_distance.hpp"
#include "core/sight/nearest_returns.hpp"
#include "core/sight/scan_view.hpp"
#include "core/sight/visibility.hpp"
#include "core/tracking/frame_findings.hpp"
#include "core/tracking/tracker_config.hpp"

namespace hulltrack {

/// One frame's scan, as the examiner needs it. Everything outlives the call.
struct SeenScan {
  const FilteredScan& filtered;
  std::span<const ScanView> views;
  std::span<const SensorConfig> sensors;
};

class Examiner {
 public:
  /// `map` is not null.
  Examiner(const TrackerConfig& config, std::shared_ptr<const HullMap> map);

  /// Examines the frame's own pose, once a frame. `covariance`: of the pose's error at the reference point,
  /// by a point-to-plane fit whose step is zero; nothing if that is not known. With the published method the
  /// step and its covariance come from the scan, and `covariance` is not used. `bend` along `shape`: of the
  /// hull.
  [[nodiscard]] Examination examine(const HullPose& pose, MeasurementTime time, const SeenScan& scan,
                                    const std::optional<Matrix6>& covariance, const BendShape& shape,
                                    const Bend& bend);

  /// What the scan says of another pose. Leaves no trace.
  [[nodiscard]] IntegrityReport report_at(const Pose& T_W_H, const SeenScan& scan);

  /// Another ship may lie there from now on.
  void forget() { integrity_.forget(); }

 private:
  [[nodiscard]] PoseObservations observe(const Pose& T_W_H, const SeenScan& scan);
  [[nodiscard]] DistanceMetrics measure(const Pose& T_W_H, const SeenScan& scan);

  TrackerConfig config_;
  std::shared_ptr<const HullMap> map_;
  Visibility visibility_;
  Integrity integrity_;
  ExpectedDistance expected_distance_;
  NearestReturns nearest_returns_;
  // Scratch:
  std::vector<VisiblePoint> visible_;
  Cloud measured_W_;               // the metrics' map points
  std::vector<double> distances_;  // from each of measured_W_ to its nearest return, m
};

}  // namespace hulltrack
