// The searches of the kd-tree, compiled once for each instruction set (SSE2, AVX2).
//
// All sets give the same answers, bit for bit: the same float operations in the same order, no fused
// multiply-add. A point's squared distance is (dx * dx + dy * dy) + dz * dz in float. A box's distance is
// computed and rounded in the same way, so that it never exceeds that of a point in the box: a search that
// skips boxes beyond its limit misses no point.
// Internal to core/kdtree. Thread rule: pure functions on an immutable layout. No failure.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/geometry/cloud.hpp"
#include "core/kdtree/kdtree.hpp"
#include "core/kdtree/kdtree_layout.hpp"

namespace hulltrack::kdtree {

inline constexpr std::uint32_t kNoSlot = 0xFFFFFFFFU;

/// A point found.
struct Hit {
  std::uint32_t slot;      // its slot in the layout; kNoSlot: nothing found
  float squared_distance;  // m^2
};

/// The largest float below radius^2. The searches take points with "squared distance <= limit"; with this
/// limit they take those with "distance < radius". Neighbouring positive floats have neighbouring bit
/// patterns.
[[nodiscard]] inline float limit_below(float radius) {
  const float squared = radius * radius;
  return radius > 0.0F && squared > 0.0F ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(squared) - 1)
                                         : -1.0F;
}

/// Takes points of a leaf: bit i of `points` stands for point i. `where` is the caller's own data.
using LeafSink = void (*)(const Leaf& leaf, std::uint32_t points, void* where);

struct Kernels {
  const char* name;

  /// Per query the nearest point with squared distance <= limit.
  void (*nearest)(const Layout& layout, std::span<const Point> queries, float limit, Hit* hits);

  /// As KdTree::neighbourhoods.
  void (*neighbourhoods)(const Layout& layout, std::span<const Point> queries, const float* radii,
                         float margin, Neighbourhood* out);

  /// The nearest hits.size() points with squared distance <= limit, nearest first, ties by index; returns
  /// how many there are.
  std::size_t (*nearest_k)(const Layout& layout, const Point& query, float limit, std::span<Hit> hits);

  /// Gives all points with squared distance <= limit to the sink, leaf by leaf.
  void (*within)(const Layout& layout, const Point& query, float limit, LeafSink sink, void* where);
};

[[nodiscard]] const Kernels& sse2_kernels();

/// The kernels must only be called if avx2_available().
[[nodiscard]] const Kernels& avx2_kernels();
[[nodiscard]] bool avx2_available();

/// The fastest kernels that this machine can run.
[[nodiscard]] const Kernels& best_kernels();

}  // namespace hulltrack::kdtree
