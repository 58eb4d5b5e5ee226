// Which target point is nearest to each source point, while the source moves by ever smaller steps?
//
// The answers are those of a fresh search, bit for bit, but most are had without one. A search brings
// the nearest few target points and a radius within which there are no others. When the source point has
// moved by m since, all others are at least (radius - m) away (triangle inequality): if one of the few is
// nearer than that, it is the nearest of all; and if (radius - m) reaches the gate, there is no other.
// Clutter, which has no partner from the first search to the last, is passed over many points at a time.
// Frames: source in its own, target in the tree's; metres. No failure; points that are not finite have no
// partner. Thread rule: one owner; scratch memory is kept. Cost: 200 bytes a source point.
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
  double distance;         // m, as the search found it: in float
  std::uint32_t index;     // of the target point, in the cloud that the tree was made of
};

class CorrespondenceCache {
 public:
  /// `gate`: the largest distance of partners (exclusive), m, > 0.
  explicit CorrespondenceCache(double gate) : gate_(static_cast<float>(gate)) {}

  /// Starts anew. Both must outlive the calls of find().
  void reset(std::span<const Point> source, const KdTree& target);

  /// The pairs within the gate with the source at T_target_source (finite), in the order of the source.
  /// The span lives until the next call.
  [[nodiscard]] std::span<const Correspondence> find(const Pose& T_target_source);

  /// Searches made in the tree since reset().
  [[nodiscard]] std::size_t searches() const { return searches_; }

 private:
  struct Nearest {
    float squared_distance = std::numeric_limits<float>::infinity();
    std::uint32_t lane = 0;  // in the point's neighbourhood
  };

  // Source points in lanes: where they are, where they were searched for, and how far from there they
  // surely have no partner (m; negative: they may have one where they stand).
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

  std::vector<Neighbourhood> near_;      // per source point: what its last search brought
  Lanes lanes_;                          // per source point, filled up to whole blocks
  float farthest_ = 0.0F;                // of the source points, from their origin, m
  std::vector<std::uint32_t> awake_;     // source points that may have a partner, in order
  std::vector<Eigen::Vector3d> places_;  // per source point that is awake, in the target's frame
  std::vector<Nearest> nearest_;         // likewise
  std::vector<std::uint32_t> unknown_;   // those to be searched for, by their place in awake_
  std::vector<Point> queries_;           // per unknown
  std::vector<float> radii_;             // per unknown: how far to search, m
  std::vector<Neighbourhood> answers_;   // per unknown
  float margin_ = 0.0F;                  // of the searches of this round, m
  std::vector<Correspondence> pairs_;
};

}  // namespace hulltrack
