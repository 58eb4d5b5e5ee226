// How far is a point from the nearest return of the scan that may be hull?
//
// The answers are those of a search in a tree over FilteredScan::hull_W, but the tree is hardly ever built.
// ScanView has the returns sorted by direction in cells of one degree:
//   1. Squares of cells around the point's direction are searched, from small to large.
//   2. A return at distance d bounds the search: all that lies within d of a point at range r is seen from
//      the sensor within asin(d / r) of the point. The nearest is known once the square holds all of that.
//   3. Points that the largest square does not decide are searched for in a tree.
// Of two returns whose distances differ by less than float rounding (1e-5 m), either may be the answer.
// Frame W, metres. No failure: without a return there is no distance. Thread rule: one owner, scratch is
// kept. Cost: 0.4 us a point where the scan is dense; a tree over the scan and 1 us a point where it is not.
#pragma once

#include <span>
#include <vector>

#include "core/filter/scan_filter.hpp"
#include "core/kdtree/kdtree.hpp"
#include "core/sight/scan_view.hpp"

namespace hulltrack {

class NearestReturns {
 public:
  /// `views`: one a LiDAR, rebuilt from `scan`. `distances` is replaced: one a point, in order; empty if the
  /// scan has no candidate for hull.
  void run(std::span<const Point> points_W, std::span<const ScanView> views, const FilteredScan& scan,
           std::vector<double>& distances);

 private:
  void ask_tree(std::span<const Point> points_W, const Cloud& hull_W, std::vector<double>& distances);

  std::vector<std::size_t> unknown_;  // indices of the points that need the tree
  Cloud queries_W_;                   // these points
  std::vector<Neighbour> answers_;
};

}  // namespace hulltrack
