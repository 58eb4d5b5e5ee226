// The searches of the kd-tree in terms of `Lanes`, eight floats of whatever instruction set.
//
// No include guard: each kdtree_query_*.cpp defines Lanes and HULLTRACK_TARGET (the attribute that
// allows the instructions) in a namespace of its own and includes this file there. Everything is inline
// code without calls into the standard library, so that no other part of the program can ever end up
// with code that its processor lacks.

struct Query {
  Lanes x, y, z;
};

HULLTRACK_TARGET inline Query broadcast(const Point& query) {
  return {broadcast(query.x()), broadcast(query.y()), broadcast(query.z())};
}

HULLTRACK_TARGET inline Lanes squared_norm(Lanes dx, Lanes dy, Lanes dz) {
  return add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz));
}

// How far q lies outside of [low, high], 0 inside.
HULLTRACK_TARGET inline Lanes outside(Lanes q, Lanes low, Lanes high) {
  return max(max(sub(low, q), sub(q, high)), zero());
}

HULLTRACK_TARGET inline Lanes squared_distance(const Query& q, const Node& node, std::size_t first) {
  return squared_norm(outside(q.x, load(node.min_x + first), load(node.max_x + first)),
                      outside(q.y, load(node.min_y + first), load(node.max_y + first)),
                      outside(q.z, load(node.min_z + first), load(node.max_z + first)));
}

HULLTRACK_TARGET inline Lanes squared_distance(const Query& q, const Leaf& leaf, std::size_t first) {
  return squared_norm(sub(load(leaf.x + first), q.x), sub(load(leaf.y + first), q.y),
                      sub(load(leaf.z + first), q.z));
}

// Squared distances of a query from the points of a leaf.
struct LeafDistances {
  Lanes block[kLeafSize / kLanes];

  HULLTRACK_TARGET LeafDistances(const Query& q, const Leaf& leaf) {
    for (std::size_t i = 0; i < kLeafSize / kLanes; ++i) {
      block[i] = squared_distance(q, leaf, i * kLanes);
    }
  }
  HULLTRACK_TARGET float least() const {
    return smallest(min(min(block[0], block[1]), min(block[2], block[3])));
  }

  HULLTRACK_TARGET void store_to(float* squared) const {
    for (std::size_t i = 0; i < kLeafSize / kLanes; ++i) {
      store(squared + i * kLanes, block[i]);
    }
  }

  // One bit a point.
  HULLTRACK_TARGET std::uint32_t within(float limit) const {
    const Lanes l = broadcast(limit);
    return at_most(block[0], l) | (at_most(block[1], l) << 8) | (at_most(block[2], l) << 16) |
           (at_most(block[3], l) << 24);
  }
};

// An opened node with children that are still to be visited.
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

// One search on its way: a query, what it has found, the opened nodes from the root to where it stands.
template <typename Collector>
struct Search {
  Point query;
  std::uint32_t next;  // the child to visit next
  std::size_t number;
  std::size_t depth;
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

  // Visits one node or leaf, then chooses and fetches the next; false when nothing is left.
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

// The queries of a batch one after the other; those that nothing can be near are answered on the way.
template <typename Collector, typename Out>
struct Batch {
  const Layout& layout;
  std::span<const Point> queries;
  const typename Collector::Task& task;
  Out* out;
  std::size_t next = 0;

  // Sets `search` on the next query; false when there are no more.
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

HULLTRACK_TARGET inline std::uint32_t first_slot(std::uint32_t leaf) {
  return leaf * static_cast<std::uint32_t>(kLeafSize);
}

// A collector gathers what one search is for. Its Task says what is asked of all queries of a batch, its
// limit is the tightest bound so far (inclusive, m^2): farther away nothing is of interest.

// The nearest point.
struct NearestCollector {
  struct Task {
    float limit;
  };

  float limit;
  std::uint32_t slot;

  HULLTRACK_TARGET void start(const Task& task, std::size_t) {
    limit = task.limit;
    slot = kNoSlot;
  }

  HULLTRACK_TARGET void scan(const Layout& layout, const Query& q, std::uint32_t leaf) {
    const LeafDistances distances(q, layout.leaves[leaf]);
    const float best = distances.least();
    if (!(best <= limit)) {
      return;
    }
    for (std::uint32_t mask = distances.within(best); mask != 0; mask &= mask - 1) {
      const std::uint32_t candidate = first_slot(leaf) + static_cast<std::uint32_t>(__builtin_ctz(mask));
      if (slot == kNoSlot || best < limit || layout.index[candidate] < layout.index[slot]) {
        slot = candidate;
        limit = best;
      }
    }
  }

  HULLTRACK_TARGET void finish(const Layout&, Hit& hit) const { hit = {slot, limit}; }
};

HULLTRACK_TARGET inline bool comes_before(const Layout& layout, const Hit& a, const Hit& b) {
  return a.squared_distance < b.squared_distance ||
         (a.squared_distance == b.squared_distance && layout.index[a.slot] < layout.index[b.slot]);
}

// Puts `hit` into its place among the best `count` so far; the last one drops out when they are full.
HULLTRACK_TARGET inline std::size_t insert(const Layout& layout, const Hit& hit, std::span<Hit> hits,
                                           std::size_t count) {
  std::size_t at = count;
  if (count == hits.size()) {
    if (!comes_before(layout, hit, hits[count - 1])) {
      return count;
    }
    at = count - 1;
  } else {
    ++count;
  }
  for (; at > 0 && comes_before(layout, hit, hits[at - 1]); --at) {
    hits[at] = hits[at - 1];
  }
  hits[at] = hit;
  return count;
}

// The nearest few points among those not farther than the nearest one and a margin. They are gathered
// unsorted, which branches little; only when they are too many the nearest are sorted out.
struct NeighbourhoodCollector {
  static constexpr std::size_t kFew = Neighbourhood::kCapacity;
  static constexpr std::size_t kRoom = kFew + kLeafSize;

  struct Task {
    const float* radii;  // per query, m
    float margin;        // m
  };

  float limit;
  float margin;
  float clear_radius;
  std::uint32_t count;
  Hit hits[kRoom];

  HULLTRACK_TARGET void start(const Task& task, std::size_t query) {
    clear_radius = task.radii[query];
    limit = limit_below(clear_radius);
    margin = task.margin;
    count = 0;
  }

  HULLTRACK_TARGET void scan(const Layout& layout, const Query& q, std::uint32_t leaf) {
    const LeafDistances distances(q, layout.leaves[leaf]);
    const float best = distances.least();
    if (!(best <= limit)) {
      return;
    }
    const float reach = __builtin_sqrtf(best) + margin;
    const float squared_reach = reach * reach > best ? reach * reach : best;  // never below by rounding
    if (squared_reach < limit) {
      limit = squared_reach;
      clear_radius = reach;
    }
    if (count > kFew) {
      keep_few(layout);
    }
    for (std::size_t i = 0; i < kLeafSize; i += kCacheLine / sizeof(std::uint32_t)) {
      __builtin_prefetch(&layout.index[first_slot(leaf) + i]);  // finish() will want it
    }
    alignas(32) float squared[kLeafSize];
    distances.store_to(squared);
    for (std::uint32_t mask = distances.within(limit); mask != 0; mask &= mask - 1) {
      const auto position = static_cast<std::uint32_t>(__builtin_ctz(mask));
      hits[count++] = {first_slot(leaf) + position, squared[position]};
    }
  }

  // Drops what the limit has overtaken and, if still necessary, all but the nearest few.
  HULLTRACK_TARGET void keep_few(const Layout& layout) {
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      hits[kept] = hits[i];
      kept += hits[i].squared_distance <= limit ? 1U : 0U;
    }
    count = kept;
    if (count > kFew) {
      std::size_t sorted = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const Hit hit = hits[i];
        sorted = insert(layout, hit, std::span<Hit>(hits, kFew), sorted);
      }
      count = kFew;
      limit = hits[kFew - 1].squared_distance;
      clear_radius = __builtin_sqrtf(limit);
    }
  }

  HULLTRACK_TARGET void finish(const Layout& layout, Neighbourhood& out) {
    keep_few(layout);
    for (std::uint32_t i = 0; i < kFew; ++i) {
      out.x[i] = out.y[i] = out.z[i] = __builtin_inff();
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      const Leaf& leaf = layout.leaves[hits[i].slot / kLeafSize];
      const std::size_t position = hits[i].slot % kLeafSize;
      out.x[i] = leaf.x[position];
      out.y[i] = leaf.y[position];
      out.z[i] = leaf.z[position];
      out.index[i] = layout.index[hits[i].slot];
    }
    out.count = count;
    out.clear_radius = clear_radius;
  }
};

// The nearest k points, nearest first.
struct KNearestCollector {
  struct Task {
    float limit;
    std::span<Hit> hits;
  };

  float limit;
  std::span<Hit> hits;
  std::size_t count;

  HULLTRACK_TARGET void start(const Task& task, std::size_t) {
    limit = task.limit;
    hits = task.hits;
    count = 0;
  }

  HULLTRACK_TARGET void scan(const Layout& layout, const Query& q, std::uint32_t leaf) {
    const LeafDistances distances(q, layout.leaves[leaf]);
    alignas(32) float squared[kLeafSize];
    distances.store_to(squared);
    for (std::uint32_t mask = distances.within(limit); mask != 0; mask &= mask - 1) {
      const auto position = static_cast<std::uint32_t>(__builtin_ctz(mask));
      count = insert(layout, {first_slot(leaf) + position, squared[position]}, hits, count);
    }
    if (count == hits.size()) {
      limit = hits[count - 1].squared_distance;
    }
  }
};

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
