// Finds the pose of the hull that explains one scan best.
//
// Each frame, the thinned scan is scored at several start poses and aligned to the map from the best of them:
//   - T_H_W = identity, the PLC's own pose: the hull lies where her map has it, if the joints are right;
//   - the last followed pose (track.hpp), and that pose carried on with the hull's speed;
//   - a challenger: a place that explains clearly more than the last frame's pose;
//   - while the pose is not unique: the places that the search of the berth has found (hull_search.hpp).
// A pose is unique if it follows from one that no other place of the berth rivalled (Track::unique).
// No error accumulates, since every frame is aligned to the map. So that a false place does not persist, each
// frame with a unique pose tries one stretch of the berth for a challenger. A frame is find(), search(), and
// learn() if nothing speaks against its pose. A search begins anew when the track wants it, or after ten
// frames in which all its starts were tried in vain. Frames: scan in W, answers as T_H_W; metres, radians.
// Failure: states in IcpResult. Thread rule: one owner. Cost: 2 ms a frame when following, up to 10 ms more
// while searching.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/filter/even_subset.hpp"
#include "core/filter/voxel_filter.hpp"
#include "core/geometry/cloud.hpp"
#include "core/localisation/bend_filter.hpp"
#include "core/localisation/hull_config.hpp"
#include "core/localisation/hull_search.hpp"
#include "core/localisation/search_progress.hpp"
#include "core/localisation/track.hpp"
#include "core/map/hull_map.hpp"
#include "core/registration/point_to_plane_icp.hpp"
#include "core/registration/point_to_point_icp.hpp"
#include "core/registration/registration_config.hpp"

namespace hulltrack {

class PoseFinder {
 public:
  /// `map` must outlive this.
  PoseFinder(const HullConfig& hull, const RegistrationConfig& registration, const HullMap& map);

  /// T_H_W of the scan `hull_W` taken at `time`. `track`: what the frames before left. The published method
  /// (point to point) gives no covariance.
  [[nodiscard]] PlaneIcpResult find(const Cloud& hull_W, MeasurementTime time, const Track& track);

  /// Does another place of the berth explain the scan as well? `answer`: that of find() for the same scan and
  /// track, and whether the scan contradicts it; nothing if find() found no pose. If it is not contradicted,
  /// one other place is examined: all of the scan is aligned from it, and `contradicts` says whether the scan
  /// contradicts the pose T_H_W that this leads to. While the pose is not unique that place is the best of
  /// the search that explains about as well (kRivals), lies elsewhere and is not examined yet. While it is
  /// unique, it is a challenger, if the stretch of the berth that is tried in this frame has one. Returns how
  /// far the search has come, and the first place that rivals the answer.
  struct Answer {
    Pose T_H_W;
    bool contradicted = false;
  };
  [[nodiscard]] SearchProgress search(const Track& track, const std::optional<Answer>& answer,
                                      const std::function<bool(const Pose& T_H_W)>& contradicts);

  /// Learns from a frame whose pose the scan did not contradict: updates the bend and the mean of
  /// PlaneCovariance::shared.
  void learn(MeasurementTime time, const PlaneIcpResult& found);
  [[nodiscard]] const Bend& bend() const { return bend_.now(); }
  [[nodiscard]] const BendShape& bend_shape() const { return bend_shape_; }
  /// Covariance of the answer of find(), whose covariance is `fit`; about the fit's centre in H, rad and m.
  [[nodiscard]] Matrix6 covariance(const PlaneCovariance& fit) const;

  /// The thinned scan of the last find(), W.
  [[nodiscard]] const Cloud& thinned_W() const { return thinned_W_; }

 private:
  void thin(const Cloud& hull_W);
  [[nodiscard]] Pose best_start(MeasurementTime time, const Track& track);
  [[nodiscard]] Pose followed(MeasurementTime time, const Track& track) const;
  void begin_search(MeasurementTime time, const Track& track);
  [[nodiscard]] std::optional<Pose> rival(const Track& track, const Pose& T_H_W);
  void settle(const Track& track, const Pose& start, const Pose& T_H_W, bool contradicted);
  [[nodiscard]] SearchProgress progress(const Pose& T_H_W) const;

  HullConfig hull_;
  RegistrationConfig registration_;
  const HullMap* map_;
  VoxelFilter voxel_filter_;
  PointToPointIcp point_icp_;
  BendShape bend_shape_;
  PointToPlaneIcp plane_icp_;
  HullSearch search_;
  BendFilter bend_;
  /// Running means of PlaneCovariance::shared. [0]: of thinned scans. [1]: of sparse scans, whose points lie
  /// closer together.
  std::array<double, 2> shared_;

  Cloud askew_;      // the scan turned by kAskew, only to choose points
  Cloud thinned_W_;  // of a sparse scan: its unthinned points, at most kMostOfSparse
  bool is_sparse_ = false;
  Cloud few_W_;                     // at most kFew of the thinned scan's points, evenly taken
  std::optional<Pose> challenger_;  // T_H_W that explains more than the last frame's pose
  std::uint64_t searches_ = 0;      // Track::searches of the last find()
  bool search_is_stale_ = true;     // the next scan with enough points begins a new one
  int frames_searched_ = 0;         // frames since all starts were tried
};

}  // namespace hulltrack
