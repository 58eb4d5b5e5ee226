// Which nodes and leaves a search visits: the nearest first. Several searches run in turn.
//
// A part of kdtree_query_body.hpp, whose rules hold here. What a search gathers is up to its Collector:
// start(), scan() of a leaf, finish(), and `limit`, the largest squared distance that is still of interest
// (inclusive, m^2). The Collector's Task holds what is asked for all queries of a batch.

// A visited node with children that are still to be visited.
struct alignas(32) Frame {
  float squared_distance[kFanOut];
  std::uint32_t first_child;
  std::uint32_t pending;  // one bit a child
};

HULLTRACK_TARGET inline bool is_searchable(const Layout& layout, const Point& query) {
  // x - x is 0 for finite numbers and NaN for all others.
  return !layout.nodes.empty() && query.x() - query.x() == 0.0F && query.y() - query.y() == 0.0F &&
         query.z() - query.z() == 0.0F;
}

HULLTRACK_TARGET inline void prefetch(const Layout& layout, std::uint32_t child) {
  const bool is_leaf = (child & kLeafFlag) != 0;
  const char* from = is_leaf ? reinterpret_cast<const char*>(&layout.leaves[child & ~kLeafFlag])
                             : reinterpret_cast<const char*>(&layout.nodes[child]);
  const char* const end = from + (is_leaf ? sizeof(Leaf) : sizeof(Node));
  for (; from < end; from += kCacheLine) {
    __builtin_prefetch(from);
  }
}

// One search: its query, what it has found so far, and the visited nodes from the root down that have
// children left to visit.
template <typename Collector>
struct Search {
  Point query;
  std::uint32_t next;  // the child to visit next
  std::size_t number;  // of the query in its batch
  std::size_t depth;   // frames in use
  Collector found;
  Frame frames[kMaxHeight];

  HULLTRACK_TARGET void start(std::size_t query_number, const Point& from,
                              const typename Collector::Task& task) {
    query = from;
    number = query_number;
    found.start(task, query_number);
    depth = 0;
    next = 0;
  }

  // Visits one node or leaf, then chooses the next one and prefetches it; false when nothing is left.
  HULLTRACK_TARGET bool step(const Layout& layout) {
    const Query q = broadcast(query);
    if ((next & kLeafFlag) == 0) {
      return open(layout, q) || back_up(layout);
    }
    found.scan(layout, q, next & ~kLeafFlag);
    return back_up(layout);
  }

  // Goes on to the nearest child of node `next` that lies within the limit; false if there is none.
  HULLTRACK_TARGET bool open(const Layout& layout, const Query& q) {
    const Lanes low = squared_distance(q, layout.nodes[next], 0);
    const Lanes high = squared_distance(q, layout.nodes[next], kLanes);
    const std::uint32_t within = within_limit(low, high);
    if (within == 0) {
      return false;
    }
    const Lanes least = broadcast(smallest(min(low, high)));
    const auto child =
        static_cast<std::uint32_t>(__builtin_ctz(at_most(low, least) | (at_most(high, least) << kLanes)));
    const std::uint32_t first_child = layout.first_child[next];
    const std::uint32_t pending = within & ~(1U << child);
    if (pending != 0) {
      Frame& frame = frames[depth++];
      store(frame.squared_distance, low);
      store(frame.squared_distance + kLanes, high);
      frame.first_child = first_child;
      frame.pending = pending;
    }
    next = first_child + child;
    prefetch(layout, next);
    return true;
  }

  // Goes on to the nearest pending child of the deepest node that has one within the limit.
  HULLTRACK_TARGET bool back_up(const Layout& layout) {
    while (depth > 0) {
      Frame& frame = frames[depth - 1];
      const std::uint32_t within =
          frame.pending & within_limit(load(frame.squared_distance), load(frame.squared_distance + kLanes));
      if (within == 0) {
        --depth;
        continue;
      }
      auto child = static_cast<std::uint32_t>(__builtin_ctz(within));
      for (std::uint32_t rest = within & (within - 1); rest != 0; rest &= rest - 1) {
        const auto other = static_cast<std::uint32_t>(__builtin_ctz(rest));
        child = frame.squared_distance[other] < frame.squared_distance[child] ? other : child;
      }
      frame.pending = within & ~(1U << child);
      depth -= frame.pending == 0 ? 1 : 0;
      next = frame.first_child + child;
      prefetch(layout, next);
      return true;
    }
    return false;
  }

  HULLTRACK_TARGET std::uint32_t within_limit(Lanes low, Lanes high) const {
    const Lanes limit = broadcast(found.limit);
    return at_most(low, limit) | (at_most(high, limit) << kLanes);
  }
};

// Hands out the queries of a batch one after the other. Queries that are not finite, or all if the tree is
// empty, are answered here with nothing.
template <typename Collector, typename Out>
struct Batch {
  const Layout& layout;
  std::span<const Point> queries;
  const typename Collector::Task& task;
  Out* out;
  std::size_t next = 0;

  // Starts `search` with the next query; false when there are no more.
  HULLTRACK_TARGET bool start_next(Search<Collector>& search) {
    for (; next < queries.size(); ++next) {
      if (is_searchable(layout, queries[next])) {
        search.start(next, queries[next], task);
        ++next;
        return true;
      }
      Collector none;
      none.start(task, next);
      none.finish(layout, out[next]);
    }
    return false;
  }
};

// Steps several searches in turn, so that each one's memory arrives while the others compute.
template <typename Collector, typename Out>
HULLTRACK_TARGET inline void search_all(const Layout& layout, std::span<const Point> queries,
                                        const typename Collector::Task& task, Out* out) {
  Batch<Collector, Out> batch{layout, queries, task, out};
  Search<Collector> active[kInterleaved];
  std::size_t running = 0;
  while (running < kInterleaved && batch.start_next(active[running])) {
    ++running;
  }
  while (running > 0) {
    for (std::size_t i = running;
         i-- > 0;) {  // from the back: the last one may take the place of a finished one
      if (active[i].step(layout)) {
        continue;
      }
      active[i].found.finish(layout, out[active[i].number]);
      if (!batch.start_next(active[i])) {
        active[i] = active[--running];
      }
    }
  }
}
