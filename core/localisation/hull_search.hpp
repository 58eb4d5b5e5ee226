// Where in the berth could the hull lie? A search of all of it, as deep as the frame's time allows.
//
// One scan cannot always tell a hull from the same hull slid along the quay, so a pose that did not follow
// from the one before must stand against all others. begin() shifts the scan over the map in steps of half a
// metre (OccupancyGrid) and keeps the best shifts as starts; each start is then aligned coarsely, a few a
// frame, and where it ends up is a place. Every frame scores the places anew. Whether the scan contradicts a
// place is not known here: the caller examines places and says so.
// Turns are not searched: starts take the last known one, and half a metre is a degree over a hatch's length.
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
    double score = 0.0;         // share of the newest scan's points that it explains
    bool contradicted = false;  // by the scan that it was last examined with
    bool explains = false;      // examined, and not contradicted
  };

  /// Poses less than this apart are one place: several times the error of an approach, and far less than any
  /// two places where a ship looks alike.
  static constexpr double kSamePlace = 0.5;  // m, of the reference point
  static constexpr std::size_t kMostPlaces = 12;

  /// `map` must outlive this.
  HullSearch(const Eigen::Vector3d& reference_H, const HullMap& map)
      : reference_H_(reference_H), map_(&map) {}

  /// Forgets all places and finds the starts within `reach`, best first, the PLC's own pose before them.
  /// `R_W_H`: the turn that they take.
  void begin(std::span<const Point> few_W, const Box& reach, const Eigen::Matrix3d& R_W_H);

  /// Aligns the next `starts` starts with a few hundred points of the scan, then scores every place.
  void advance(std::span<const Point> few_W, std::size_t starts, PointToPlaneIcp& icp);

  /// Looks at another stretch of the berth in each call, from 40 m on one side of T_H_W to 40 m on the other.
  /// The best place there, if it explains `margin` times as much as T_H_W does.
  [[nodiscard]] std::optional<Pose> challenge(std::span<const Point> few_W, const Pose& T_H_W, double margin,
                                              PointToPlaneIcp& icp);

  [[nodiscard]] std::size_t tried() const { return next_; }
  [[nodiscard]] std::size_t starts() const { return starts_.size(); }
  [[nodiscard]] bool complete() const { return next_ == starts_.size(); }

  /// Best first.
  [[nodiscard]] std::span<const Place> places() const { return places_; }

  /// Says that the place at `from` was aligned with all of the scan, which led to `to`, and whether the scan
  /// contradicts that. `from` need not be a place.
  void settle(const Pose& from, const Pose& to, bool contradicted);

  /// Share of the scan that a pose explains.
  [[nodiscard]] double score(std::span<const Point> few_W, const Pose& T_H_W, PointToPlaneIcp& icp) const;

  /// How far apart two poses put the reference point, m.
  [[nodiscard]] double distance(const Pose& a, const Pose& b) const;

 private:
  /// Shifts of the hull in H that make most of the scan fall onto the map, best first: at most `most`.
  [[nodiscard]] std::vector<Eigen::Vector3d> best_shifts(std::span<const Point> few_W, const Box& reach,
                                                         const Eigen::Matrix3d& R_W_H,
                                                         std::size_t most) const;
  [[nodiscard]] Pose shifted(const Eigen::Vector3d& shift_H, const Eigen::Matrix3d& R_W_H) const;
  void add(const Place& place);
  /// The best of T_H_W and places some decimetres beside it, along the ship and across her.
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
