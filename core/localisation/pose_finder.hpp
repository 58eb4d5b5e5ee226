// Finds the pose of the hull that explains one scan best.
//
// Each frame, the thinned scan is scored at several start poses and aligned to the map from the best of them:
//   - T_H_W = identity, the PLC's own pose: the hull lies where her map has it, if the joints are right;
//   - the last followed pose (track.hpp), and that pose carried on with the hull's speed;
//   - a challenger: a place that explains clearly more than the last frame's pose;
//   - while the pose is not unique: the places that the search of the berth has found (hull_search.hpp).
// A pose is unique if it follows from one that no other place of the berth rivalled (Track::unique).
// No error accumulates, since every frame is aligned to the map. So that a false place does not persist, each
// frame with a unique pose tries one stretch of the berth for a challenger.
// Frames: scan in W, answers as T_H_W; metres, radians. Failure: states in IcpResult.
// Thread rule: one owner. Cost: 2 ms a frame when following, up to 10 ms more while searching.
#pragma once

#include <array>
#include <optional>

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

  /// A place to examine beside T_H_W, the answer of find(), and what aligning all of the scan from it leads
  /// to. While T_H_W is not unique: the best place of the search that explains about as well (kRivals), lies
  /// elsewhere and is not examined yet. While T_H_W is unique: a challenger, if the stretch of the berth that
  /// is tried in this frame has one. Nothing if there is none.
  struct Rival {
    Pose start;  // T_H_W, the place
    Pose T_H_W;  // what aligning from it led to
  };
  [[nodiscard]] std::optional<Rival> rival(const Pose& T_H_W);

  /// Learns from a frame whose pose the scan did not contradict: updates the bend and the mean of
  /// PlaneCovariance::shared.
  void learn(MeasurementTime time, const PlaneIcpResult& found);
  [[nodiscard]] const Bend& bend() const { return bend_.now(); }
  [[nodiscard]] const BendShape& bend_shape() const { return bend_shape_; }
  /// Covariance of the answer of find(), whose covariance is `fit`; about the fit's centre in H, rad and m.
  [[nodiscard]] Matrix6 covariance(const PlaneCovariance& fit) const;

  /// Tells how the examination of a pose ended. `start` and T_H_W: both the answer of find(), or the members
  /// of a Rival. While the pose is unique this only drops a challenger that the scan contradicts.
  void settle(const Pose& start, const Pose& T_H_W, bool contradicted);

  /// How far the search has come, and the first place that rivals `T_H_W`, the answer of find().
  [[nodiscard]] SearchProgress progress(const Pose& T_H_W) const;

  /// To be called when the frame is judged. Remembers a unique pose. The search begins anew after a
  /// re-acquire edge, when the pose is no longer unique, or after ten frames in which it had tried all starts
  /// in vain.
  void judged(const Track& track, bool reacquire);

  /// The thinned scan of the last find(), W.
  [[nodiscard]] const Cloud& thinned_W() const { return thinned_W_; }

 private:
  void thin(const Cloud& hull_W);
  [[nodiscard]] Pose best_start(MeasurementTime time, const Track& track);
  [[nodiscard]] Pose followed(MeasurementTime time, const Track& track) const;
  void begin_search(MeasurementTime time);
  [[nodiscard]] Rival aligned(const Pose& start);

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
  Cloud few_W_;                            // at most kFew of the thinned scan's points, evenly taken
  std::optional<Pose> challenger_;         // T_H_W that explains more than the last frame's pose
  std::optional<FollowedPose> last_seen_;  // last unique pose since the last re-acquire edge
  bool unique_ = false;                    // Track::unique when the last frame was judged
  bool search_is_stale_ = true;            // the next scan with enough points begins a new one
  int frames_searched_ = 0;                // frames since all starts were tried
};

}  // namespace hulltrack
