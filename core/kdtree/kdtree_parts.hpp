// What the builders of the kd-tree share: points not yet in the tree, tight boxes, leaves and nodes.
//
// Internal to core/kdtree. Unused lanes are at infinity: no query is near them.
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "core/kdtree/kdtree_layout.hpp"

namespace hulltrack::kdtree {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A point and its index in the cloud, as one register.
struct alignas(16) Element {
  std::array<float, 3> position;
  std::uint32_t index;
};

/// The tight box of some points; the default is the box of none.
struct Bounds {
  std::array<float, 4> min{kInfinity, kInfinity, kInfinity, 0.0F};
  std::array<float, 4> max{-kInfinity, -kInfinity, -kInfinity, 0.0F};

  [[nodiscard]] std::size_t longest_axis() const {
    const std::array<float, 3> side{max[0] - min[0], max[1] - min[1], max[2] - min[2]};
    return static_cast<std::size_t>(std::max_element(side.begin(), side.end()) - side.begin());
  }

  void add(const Bounds& other) {
    for (std::size_t i = 0; i < min.size(); ++i) {
      min[i] = std::min(min[i], other.min[i]);
      max[i] = std::max(max[i], other.max[i]);
    }
  }
};

// The fourth lane of a load is the element's index; it is not used.
inline Bounds bounds_of(std::span<const Element> range) {
  Bounds bounds;
  __m128 low = _mm_loadu_ps(bounds.min.data());
  __m128 high = _mm_loadu_ps(bounds.max.data());
  for (const Element& e : range) {
    const __m128 p = _mm_load_ps(e.position.data());
    low = _mm_min_ps(p, low);
    high = _mm_max_ps(p, high);
  }
  _mm_storeu_ps(bounds.min.data(), low);
  _mm_storeu_ps(bounds.max.data(), high);
  return bounds;
}

/// A node with the boxes of its children, at most kFanOut.
inline Node node_of(std::span<const Bounds> children) {
  Node node;
  for (std::size_t lane = 0; lane < kFanOut; ++lane) {
    const Bounds box = lane < children.size() ? children[lane] : Bounds{};
    node.min_x[lane] = box.min[0];
    node.min_y[lane] = box.min[1];
    node.min_z[lane] = box.min[2];
    node.max_x[lane] = box.max[0];
    node.max_y[lane] = box.max[1];
    node.max_z[lane] = box.max[2];
  }
  return node;
}

/// Appends a leaf of at most kLeafSize points.
inline void add_leaf(std::span<const Element> points, Layout& layout) {
  Leaf& leaf = layout.leaves.emplace_back();
  std::fill_n(leaf.x, kLeafSize, kInfinity);
  std::fill_n(leaf.y, kLeafSize, kInfinity);
  std::fill_n(leaf.z, kLeafSize, kInfinity);
  for (std::size_t i = 0; i < points.size(); ++i) {
    leaf.x[i] = points[i].position[0];
    leaf.y[i] = points[i].position[1];
    leaf.z[i] = points[i].position[2];
    layout.index.push_back(points[i].index);
  }
  layout.index.resize(layout.leaves.size() * kLeafSize, std::numeric_limits<std::uint32_t>::max());
}

}  // namespace hulltrack::kdtree
