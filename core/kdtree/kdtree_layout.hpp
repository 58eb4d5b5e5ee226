// How the kd-tree lies in memory: wide nodes of tight boxes over full leaves, both in SIMD order.
//
// A node keeps the boxes of up to 16 children side by side, so that one or two vector operations a plane test
// all of them; siblings are contiguous, so that one index addresses them. All leaves lie at the same
// depth and hold up to 32 points. Unused lanes are at infinity and never match.
// Internal to core/kdtree. Immutable once built; see kdtree_build.hpp and kdtree_query.hpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/kdtree/huge_pages.hpp"

namespace hulltrack::kdtree {

inline constexpr std::size_t kFanOut = 16;
inline constexpr std::size_t kLanes = 8;  // floats that one operation of the searches works on
inline constexpr std::size_t kLeafSize = 32;

/// Set in Layout::first_child when the children are leaves.
inline constexpr std::uint32_t kLeafFlag = 0x80000000U;

/// 16^7 leaves of 32 are more points than an index can count.
inline constexpr std::size_t kMaxHeight = 7;

inline constexpr std::size_t kCacheLine = 64;

/// Searches under way at a time in a batch: enough to hide the memory's latency (measured).
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
