// Which pose explains this scan best? Start poses, the alignment from the best of them, and the search for
// others while nothing vouches for the place.
//
// Starts are the PLC's own pose (no motion of the hull at all), the hull followed from the last frames with
// its speed, and what the search found; the one that explains most of the scan is aligned. Since the PLC's
// start is always among them and every frame is aligned to the map, no error accumulates; that a false place
// does not persist either is the business of one challenge a frame.
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
#include "core/localisation/search_evidence.hpp"
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

  /// T_H_W of the scan `hull_W` taken at `time`. `track`: of the frames before. The published method has no
  /// covariance.
  [[nodiscard]] PlaneIcpResult find(const Cloud& hull_W, MeasurementTime time, const Track& track);

  /// The place to examine beside T_H_W in this frame, aligned with all of the scan. While T_H_W is not
  /// unique: the next one of the search that explains the scan about as well. Afterwards: a challenger, if
  /// one stretch of the berth, another each frame, has a place that explains clearly more.
  struct Rival {
    Pose start;  // T_H_W, the place
    Pose T_H_W;  // what aligning it led to
  };
  [[nodiscard]] std::optional<Rival> rival(const Pose& T_H_W);

  /// Learns from a frame that the scan did not contradict: the bend, and how much residuals share.
  void learn(MeasurementTime time, const PlaneIcpResult& found);
  [[nodiscard]] const Bend& bend() const { return bend_.now(); }
  [[nodiscard]] const BendShape& bend_shape() const { return bend_shape_; }
  /// Of the answer of find(), about its centre in H.
  [[nodiscard]] Matrix6 covariance(const PlaneCovariance& fit) const;

  /// What examining a pose came to: of find() (which is its own start) or of rival().
  void settle(const Pose& start, const Pose& T_H_W, bool contradicted);

  /// Where the search stands; `T_H_W` is the answer of find().
  [[nodiscard]] SearchEvidence evidence(const Pose& T_H_W) const;

  /// To be called when the frame is judged: begins a search when it is due.
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
  /// Means of PlaneCovariance::shared, of scans that were thinned and of sparse ones, whose points are
  /// closer.
  std::array<double, 2> shared_;

  Cloud askew_;      // the scan in the voxels' axes
  Cloud thinned_W_;  // all of a sparse scan
  bool is_sparse_ = false;
  Cloud few_W_;                            // of the thinned scan, evenly taken
  std::optional<Pose> challenger_;         // T_H_W, found by the last frame, explains more than its pose
  std::optional<FollowedPose> last_seen_;  // since the last re-acquire edge
  bool unique_ = false;                    // of the track, when the last frame was judged
  bool search_is_stale_ = true;            // it begins anew with the next scan that shows enough
  int frames_searched_ = 0;                // since all starts were tried
};

}  // namespace hulltrack
