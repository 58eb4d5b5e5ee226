// Which target point is nearest to each source point, while the source moves by ever smaller steps?
//
// The answers are those of a fresh search, bit for bit, but most need none. The last search of a source point
// brought the nearest few target points (the known ones) and a radius within which there are no others. Once
// the source point has moved by a distance s, all others are at least (radius - s) away (triangle
// inequality). So a known point that is nearer than that is the nearest of all. If no known point is, but
// (radius - s) reaches the gate, the source point has no partner. Otherwise it is searched for again.
// Source points far from the target stay without a partner for many steps. They are checked 64 at a time, for
// speed.
// Frames: source in its own, target in the tree's; metres. Cannot fail; points that are not finite have no
// partner.
// Thread rule: one owner; scratch memory is kept. Cost: 200 bytes a source point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"
#include "core/kdtree/kdtree.hpp"

namespace hulltrack {

/// A source point at its present place and the target point nearest to it.
struct Correspondence {
  Eigen::Vector3d source;  // in the target's frame, m
  Eigen::Vector3d target;  // m
  double distance;         // m, computed in float as the search does it
  std::uint32_t index;     // of the target point, in the cloud that the tree was made of
};

class CorrespondenceCache {
 public:
  /// `gate`: the largest distance of partners (exclusive), m, > 0.
  explicit CorrespondenceCache(double gate) : gate_(static_cast<float>(gate)) {}

  /// Forgets all searches. `source` and `target` must outlive the calls of find().
  void reset(std::span<const Point> source, const KdTree& target);

  /// The pairs within the gate with the source at T_target_source (finite), in the order of the source.
  /// The span lives until the next call.
  [[nodiscard]] std::span<const Correspondence> find(const Pose& T_target_source);

  /// Searches made in the tree since reset().
  [[nodiscard]] std::size_t searches() const { return searches_; }

 private:
  struct Nearest {
    float squared_distance = std::numeric_limits<float>::infinity();
    std::uint32_t lane = 0;  // position in the point's Neighbourhood
  };

  // Per source point, as separate vectors for vector instructions: its place in its own frame, its place in
  // the target's frame at its last search, and how far it may move from there before it can get a partner, m
  // (`alone`; negative: it may have one already).
  struct Lanes {
    std::vector<float> x, y, z, searched_x, searched_y, searched_z, alone;

    void reset(std::size_t size);
    [[nodiscard]] Point searched(std::size_t i) const {
      return {searched_x[i], searched_y[i], searched_z[i]};
    }
  };

  [[nodiscard]] static Nearest nearest_of(const Neighbourhood& near, const Point& q);
  void find_awake(const Pose& T_target_source);
  void look_up(const Pose& T_target_source);
  void search_unknown();

  float gate_;
  std::span<const Point> source_;
  const KdTree* target_ = nullptr;
  std::size_t searches_ = 0;

  std::vector<Neighbourhood> near_;      // per source point: result of its last search
  Lanes lanes_;                          // per source point, filled up to whole blocks
  float farthest_ = 0.0F;                // largest distance of a source point from the source's origin, m
  std::vector<std::uint32_t> awake_;     // source points that may have a partner, in order
  std::vector<Eigen::Vector3d> places_;  // per awake point: its place in the target's frame
  std::vector<Nearest> nearest_;         // per awake point: the nearest target point
  std::vector<std::uint32_t> unknown_;   // awake points that need a search, as positions in awake_
  std::vector<Point> queries_;           // per unknown point
  std::vector<float> radii_;             // per unknown point: how far to search, m
  std::vector<Neighbourhood> answers_;   // per unknown point
  float margin_ = 0.0F;                  // searches also bring points this much beyond the nearest, m
  std::vector<Correspondence> pairs_;
};

}  // namespace hulltrack
