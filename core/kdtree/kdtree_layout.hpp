// How the kd-tree lies in memory: nodes with the tight boxes of many children, over full leaves, both in SIMD
// order.
//
// A node keeps the boxes of up to 16 children side by side, so that one or two vector operations compare a
// query with one side of all of them. Siblings are contiguous, so that the index of the first one is enough.
// All leaves lie at the same depth and hold up to 32 points. Unused lanes are at infinity and never match.
// Internal to core/kdtree. Immutable once built; see kdtree_build.hpp and kdtree_query.hpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/kdtree/huge_pages.hpp"

namespace hulltrack::kdtree {

inline constexpr std::size_t kFanOut = 16;    // children of a node, at most
inline constexpr std::size_t kLanes = 8;      // floats that one operation of the searches works on
inline constexpr std::size_t kLeafSize = 32;  // points of a leaf, at most

/// Set in Layout::first_child when the children are leaves.
inline constexpr std::uint32_t kLeafFlag = 0x80000000U;

/// Levels of nodes: 16^7 leaves of 32 points are more than a 32-bit index can count.
inline constexpr std::size_t kMaxHeight = 7;

inline constexpr std::size_t kCacheLine = 64;

/// Searches of a batch that run in turn: enough to hide the memory's latency (measured).
inline constexpr std::size_t kInterleaved = 12;

struct alignas(kCacheLine) Node {
  float min_x[kFanOut], max_x[kFanOut];
  float min_y[kFanOut], max_y[kFanOut];
  float min_z[kFanOut], max_z[kFanOut];
};

struct alignas(kCacheLine) Leaf {
  float x[kLeafSize], y[kLeafSize], z[kLeafSize];
};

/// Node 0 is the root; no nodes = empty tree. A slot is leaf * kLeafSize + position in the leaf.
struct Layout {
  LargeArray<Node> nodes;
  LargeArray<std::uint32_t> first_child;  // per node: its first child's index, with kLeafFlag for leaves
  LargeArray<Leaf> leaves;
  LargeArray<std::uint32_t> index;  // per slot: index into the cloud
  std::size_t size = 0;             // points
};

}  // namespace hulltrack::kdtree
