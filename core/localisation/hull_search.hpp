// Where in the berth could the hull lie? A search of the whole berth, spread over frames.
//
// One scan cannot always tell a hull from the same hull slid along the quay. So a pose that does not follow
// from the one before is compared with all other places. A place is a pose that the search has found, with
// its score.
//   begin()      shifts the scan over the map in steps of 0.5 m (OccupancyGrid); the best shifts are the
//                starts.
//   advance()    aligns a few starts a frame coarsely, each ends at a place; then scores all places anew.
//   settle()     takes the caller's word whether the scan contradicts a place; that is not known here.
//   challenge()  tries one stretch of the berth on its own, while the pose is certain.
// Only shifts are searched: all starts have the last known attitude. A step of 0.5 m is as much as a turn of
// a degree over a hatch's length.
// `few_W`: a few hundred points of the scan, evenly taken.
// Frames: scan in W, places as T_H_W, reach as displacement of the reference point in W; metres, radians.
// Thread rule: one owner. Cost: begin() 2 ms, advance() 0.5 ms a start, challenge() 0.7 ms.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/box.hpp"
#include "core/geometry/se3.hpp"
#include "core/map/hull_map.hpp"
#include "core/registration/point_to_plane_icp.hpp"

namespace hulltrack {

class HullSearch {
 public:
  struct Place {
    Pose T_H_W;
    double score = 0.0;         // score() with the newest scan
    bool contradicted = false;  // by the scan that it was last examined with
    bool explains = false;      // it was examined with all of a scan, and not contradicted
  };

  /// Poses less than this apart are one place: several times the error of an approach, and far less than lies
  /// between two places where a ship looks alike.
  static constexpr double kSamePlace = 0.5;  // m, of the reference point
  static constexpr std::size_t kMostPlaces = 12;

  /// `map` must outlive this.
  HullSearch(const Eigen::Vector3d& reference_H, const HullMap& map)
      : reference_H_(reference_H), map_(&map) {}

  /// Forgets all places and finds the starts: T_H_W = identity (the PLC's own pose), then the shifts within
  /// `reach` that fit best, best first. `R_W_H`: the attitude of the shifted starts.
  void begin(std::span<const Point> few_W, const Box& reach, const Eigen::Matrix3d& R_W_H);

  /// Aligns the next `starts` starts coarsely, then scores every place.
  void advance(std::span<const Point> few_W, std::size_t starts, PointToPlaneIcp& icp);

  /// Each call tries the next of twenty stretches of 4 m, from 40 m on one side of T_H_W to 40 m on the
  /// other. The best shift of the hull into the stretch, if more than 1 m away, is aligned coarsely. The
  /// answer is the pose that this leads to, if its score is more than `margin` times that of T_H_W.
  [[nodiscard]] std::optional<Pose> challenge(std::span<const Point> few_W, const Pose& T_H_W, double margin,
                                              PointToPlaneIcp& icp);

  [[nodiscard]] std::size_t tried() const { return next_; }
  [[nodiscard]] std::size_t starts() const { return starts_.size(); }
  [[nodiscard]] bool complete() const { return next_ == starts_.size(); }

  /// Best first.
  [[nodiscard]] std::span<const Place> places() const { return places_; }

  /// Says that all of the scan was aligned from `from`, which led to `to`, and whether the scan contradicts
  /// `to`. Places within kSamePlace of either are replaced by `to`. `from` need not be a place.
  void settle(const Pose& from, const Pose& to, bool contradicted);

  /// Share of the points that a pose explains, 0 .. 1: a point counts 1 on a plane of the map, a half at 10
  /// cm from it, 0 where there is no plane (PlaneScore).
  [[nodiscard]] double score(std::span<const Point> few_W, const Pose& T_H_W, PointToPlaneIcp& icp) const;

  /// How far apart two poses put the reference point, m.
  [[nodiscard]] double distance(const Pose& a, const Pose& b) const;

 private:
  /// Shifts of the hull in H by which the scan falls onto the most valuable cells of the OccupancyGrid, best
  /// first. Of shifts near each other only the best is taken. At most `most`.
  [[nodiscard]] std::vector<Eigen::Vector3d> best_shifts(std::span<const Point> few_W, const Box& reach,
                                                         const Eigen::Matrix3d& R_W_H,
                                                         std::size_t most) const;
  [[nodiscard]] Pose shifted(const Eigen::Vector3d& shift_H, const Eigen::Matrix3d& R_W_H) const;
  void add(const Place& place);
  /// Tries T_H_W moved by a few decimetres either way, along X of H and then along Y: the pose with the best
  /// score.
  [[nodiscard]] Pose slide(std::span<const Point> few_W, const Pose& T_H_W, PointToPlaneIcp& icp) const;
  void score_places(std::span<const Point> few_W, PointToPlaneIcp& icp);

  Eigen::Vector3d reference_H_;
  const HullMap* map_;
  std::vector<Pose> starts_;
  std::size_t next_ = 0;
  std::size_t challenges_ = 0;
  std::vector<Place> places_;
};

}  // namespace hulltrack
