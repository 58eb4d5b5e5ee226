// What a search gathers (the Collector of kdtree_query_traversal.hpp): the nearest point, the nearest few
// with a margin, the nearest k, or all within the limit.
//
// A part of kdtree_query_body.hpp, whose rules hold here.

HULLTRACK_TARGET inline std::uint32_t first_slot(std::uint32_t leaf) {
  return leaf * static_cast<std::uint32_t>(kLeafSize);
}

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

// Inserts `hit` into `hits`, of which the first `count` are in order; if all are in use the last one drops
// out. Returns the new count.
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

// The points that are at most a margin farther than the nearest one; of more than kFew the nearest. They are
// gathered unsorted, with few branches; the nearest are sorted out only when there are too many.
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
    const float squared_reach = reach * reach > best ? reach * reach : best;  // not below best by rounding
    if (squared_reach < limit) {
      limit = squared_reach;
      clear_radius = reach;
    }
    if (count > kFew) {
      keep_few(layout);
    }
    for (std::size_t i = 0; i < kLeafSize; i += kCacheLine / sizeof(std::uint32_t)) {
      __builtin_prefetch(&layout.index[first_slot(leaf) + i]);  // finish() reads it
    }
    alignas(32) float squared[kLeafSize];
    distances.store_to(squared);
    for (std::uint32_t mask = distances.within(limit); mask != 0; mask &= mask - 1) {
      const auto position = static_cast<std::uint32_t>(__builtin_ctz(mask));
      hits[count++] = {first_slot(leaf) + position, squared[position]};
    }
  }

  // Drops hits that the limit, lowered since, excludes; if there are still too many, all but the nearest few.
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

// All points within the limit.
struct WithinCollector {
  struct Task {
    float limit;
    LeafSink sink;
    void* where;
  };

  float limit;
  LeafSink sink;
  void* where;

  HULLTRACK_TARGET void start(const Task& task, std::size_t) {
    limit = task.limit;
    sink = task.sink;
    where = task.where;
  }

  HULLTRACK_TARGET void scan(const Layout& layout, const Query& q, std::uint32_t leaf) {
    const std::uint32_t points = LeafDistances(q, layout.leaves[leaf]).within(limit);
    if (points != 0) {
      sink(layout.leaves[leaf], points, where);
    }
  }
};
