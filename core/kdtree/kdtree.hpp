// Which point of a fixed cloud is nearest to a query? Exact answers, bounded by a radius.
//
// Frames: whatever frame the cloud is in; metres, float. Immutable after construction, so that any number of
// threads may query. Points are copied into the tree (leaf order, structure of arrays). Indices in answers
// are those of the cloud given to the constructor.
// Cannot fail. An empty cloud gives empty answers. Points of the cloud with a NaN or infinity are left out,
// and a query point with one finds nothing.
// Cost: about 17 bytes a point; a query looks at a handful of leaves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/cloud.hpp"

namespace hulltrack {

struct Neighbour {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  std::uint32_t index;     // into the cloud given to the tree
  float squared_distance;  // m^2
};

/// The nearest few points of a query with their coordinates, and how far away all others are at least. With
/// these a caller can answer for a query that has moved a little, without a search.
struct Neighbourhood {
  static constexpr std::size_t kCapacity = 8;

  std::array<float, kCapacity> x, y, z;        // m; infinity beyond `count`
  std::array<std::uint32_t, kCapacity> index;  // into the cloud given to the tree
  std::uint32_t count;                         // the first `count` entries are points, nearest first
  float clear_radius;                          // every point not listed is at least this far away, m
};

/// What a tree is built for. It decides the cost, not the answers.
enum class TreeUse {
  many_searches,  // the map: built once
  one_batch,      // a scan: built in less than half of the time, searched in twice the time
};

class KdTree {
 public:
  explicit KdTree(std::span<const Point> cloud, TreeUse use = TreeUse::many_searches);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  /// The nearest point with distance < radius (m, > 0, may be infinite), or nothing.
  /// Equal distances: the lowest index wins.
  [[nodiscard]] std::optional<Neighbour> nearest(const Point& query, float radius) const;

  /// Up to k nearest points with distance < radius, nearest first, ties by index. `out` is replaced.
  void nearest_k(const Point& query, std::size_t k, float radius, std::vector<Neighbour>& out) const;

  /// The points with distance < radius, in an order that depends on the cloud and the query alone. `out` is
  /// replaced. Several times as fast as nearest_k(), which sorts.
  void within(const Point& query, float radius, Cloud& out) const;

  /// As nearest() for many queries at once: out[i] answers queries[i], with index kNone where there is
  /// nothing. Faster, because one search computes while others wait for memory. `out` has the size of
  /// `queries`.
  void nearest(std::span<const Point> queries, float radius, std::span<Neighbour> out) const;

  /// For each query the points with distance < its radius (m, > 0) that are at most `margin` (m, >= 0)
  /// farther than the nearest one. If these are more than a Neighbourhood holds, the nearest of them. `radii`
  /// and `out` have the size of `queries`. A query that is not finite has no neighbours and clear_radius =
  /// its radius.
  void neighbourhoods(std::span<const Point> queries, std::span<const float> radii, float margin,
                      std::span<Neighbourhood> out) const;

  /// Points in the tree: those of the cloud that are finite.
  [[nodiscard]] std::size_t size() const;

  /// Heap memory that the tree holds, bytes.
  [[nodiscard]] std::size_t memory() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace hulltrack
