// The searches of the kd-tree, written in terms of `Lanes`: eight floats, in the registers of one instruction
// set.
//
// No include guard: each kdtree_query_*.cpp defines Lanes and HULLTRACK_TARGET (the attribute that
// allows the instructions) in a namespace of its own and includes this file there. Everything is inline
// code without calls into the standard library: the linker then cannot give another part of the program a
// function with instructions that the processor lacks.

// In this order: each needs the one before.
// clang-format off
#include "core/kdtree/kdtree_query_distances.hpp"
#include "core/kdtree/kdtree_query_traversal.hpp"
#include "core/kdtree/kdtree_query_collectors.hpp"
// clang-format on

HULLTRACK_TARGET void nearest(const Layout& layout, std::span<const Point> queries, float limit, Hit* hits) {
  search_all<NearestCollector>(layout, queries, {limit}, hits);
}

HULLTRACK_TARGET void neighbourhoods(const Layout& layout, std::span<const Point> queries, const float* radii,
                                     float margin, Neighbourhood* out) {
  search_all<NeighbourhoodCollector>(layout, queries, {radii, margin}, out);
}

HULLTRACK_TARGET std::size_t nearest_k(const Layout& layout, const Point& query, float limit,
                                       std::span<Hit> hits) {
  if (hits.empty() || !is_searchable(layout, query)) {
    return 0;
  }
  Search<KNearestCollector> search;
  search.start(0, query, {limit, hits});
  while (search.step(layout)) {
  }
  return search.found.count;
}

HULLTRACK_TARGET void within(const Layout& layout, const Point& query, float limit, LeafSink sink,
                             void* where) {
  if (!is_searchable(layout, query)) {
    return;
  }
  Search<WithinCollector> search;
  search.start(0, query, {limit, sink, where});
  while (search.step(layout)) {
  }
}
