// Which point of a fixed cloud is nearest to a query? Exact answers, bounded by a radius.
//
// Frames: whatever frame the cloud is in; metres, float. Immutable after construction, so any number
// of threads may query. Points are copied into the tree (leaf order, structure of arrays); indices in
// answers are those of the cloud given to the constructor.
// Failure: none; an empty cloud gives empty answers; points with a NaN or infinity are left out.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct Neighbour {
  std::uint32_t index;     // into the cloud given to the tree
  float squared_distance;  // m^2
};

class KdTree {
 public:
  explicit KdTree(std::span<const Point> cloud);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  /// The nearest point with distance < radius (m, > 0, may be infinite), or nothing.
  /// Equal distances: the lowest index wins.
  [[nodiscard]] std::optional<Neighbour> nearest(const Point& query, float radius) const;

  /// Up to k nearest points with distance < radius, nearest first, ties by index. `out` is replaced.
  void nearest_k(const Point& query, std::size_t k, float radius, std::vector<Neighbour>& out) const;

  [[nodiscard]] std::size_t size() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace hulltrack
