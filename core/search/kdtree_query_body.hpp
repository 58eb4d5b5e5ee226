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

HULLTRACK_TARGET inline Lanes squared_distance(const Query& q, const Node& node) {
  return squared_norm(outside(q.x, load(node.min_x), load(node.max_x)),
                      outside(q.y, load(node.min_y), load(node.max_y)),
                      outside(q.z, load(node.min_z), load(node.max_z)));
}

HULLTRACK_TARGET inline Lanes squared_distance(const Query& q, const Leaf& leaf, std::size_t first) {
  return squared_norm(sub(load(leaf.x + first), q.x), sub(load(leaf.y + first), q.y),
                      sub(load(leaf.z + first), q.z));
}

// A child still to be visited: nodes as they are, leaves with kLeafFlag.
struct Pending {
  float squared_distance;
  std::uint32_t child;
};

struct Stack {
  Pending entries[kMaxHeight * kFanOut];
  std::size_t size = 0;
};

// Puts the children of `node` within `limit` on the stack, the nearest on top.
HULLTRACK_TARGET inline void push_children(const Layout& layout, std::uint32_t node, const Query& q,
                                           float limit, Stack& stack) {
  const Lanes distance = squared_distance(q, layout.nodes[node]);
  std::uint32_t mask = at_most(distance, broadcast(limit));
  alignas(32) float squared[kFanOut];
  store(squared, distance);
  const std::uint32_t first = layout.first_child[node];
  const std::size_t base = stack.size;
  for (; mask != 0; mask &= mask - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(mask));
    const Pending pending{squared[lane], first + lane};
    std::size_t at = stack.size++;
    for (; at > base && stack.entries[at - 1].squared_distance < pending.squared_distance; --at) {
      stack.entries[at] = stack.entries[at - 1];
    }
    stack.entries[at] = pending;
  }
}

// Takes the next leaf within `limit` from the stack, opening nodes on the way; false at the end.
HULLTRACK_TARGET inline bool next_leaf(const Layout& layout, const Query& q, float limit, Stack& stack,
                                       std::uint32_t& leaf) {
  while (stack.size > 0) {
    const Pending next = stack.entries[--stack.size];
    if (!(next.squared_distance <= limit)) {
      continue;
    }
    if ((next.child & kLeafFlag) != 0) {
      leaf = next.child & ~kLeafFlag;
      return true;
    }
    push_children(layout, next.child, q, limit, stack);
  }
  return false;
}

HULLTRACK_TARGET inline bool is_searchable(const Layout& layout, const Point& query) {
  // x - x is 0 for finite numbers and NaN for all others.
  return !layout.nodes.empty() && query.x() - query.x() == 0.0F && query.y() - query.y() == 0.0F &&
         query.z() - query.z() == 0.0F;
}

HULLTRACK_TARGET bool nearest(const Layout& layout, const Point& query, float limit, Hit& hit) {
  if (!is_searchable(layout, query)) {
    return false;
  }
  const Query q = broadcast(query);
  bool found = false;
  Stack stack;
  stack.entries[stack.size++] = {0.0F, 0};
  for (std::uint32_t leaf = 0; next_leaf(layout, q, limit, stack, leaf);) {
    Lanes distance[kLeafSize / kFanOut];
    for (std::size_t block = 0; block < kLeafSize / kFanOut; ++block) {
      distance[block] = squared_distance(q, layout.leaves[leaf], block * kFanOut);
    }
    const Lanes least = min(min(distance[0], distance[1]), min(distance[2], distance[3]));
    if (at_most(least, broadcast(limit)) == 0) {
      continue;
    }
    const float best = smallest(least);
    for (std::size_t block = 0; block < kLeafSize / kFanOut; ++block) {
      for (std::uint32_t mask = at_most(distance[block], broadcast(best)); mask != 0; mask &= mask - 1) {
        const auto slot = static_cast<std::uint32_t>(leaf * kLeafSize + block * kFanOut +
                                                     static_cast<std::size_t>(__builtin_ctz(mask)));
        if (!found || best < hit.squared_distance || layout.index[slot] < layout.index[hit.slot]) {
          hit = {slot, best};
          found = true;
        }
      }
    }
    limit = best;
  }
  return found;
}

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

HULLTRACK_TARGET std::size_t nearest_k(const Layout& layout, const Point& query, float limit,
                                       std::span<Hit> hits) {
  if (hits.empty() || !is_searchable(layout, query)) {
    return 0;
  }
  const Query q = broadcast(query);
  std::size_t count = 0;
  Stack stack;
  stack.entries[stack.size++] = {0.0F, 0};
  for (std::uint32_t leaf = 0; next_leaf(layout, q, limit, stack, leaf);) {
    for (std::size_t block = 0; block < kLeafSize; block += kFanOut) {
      const Lanes distance = squared_distance(q, layout.leaves[leaf], block);
      std::uint32_t mask = at_most(distance, broadcast(limit));
      if (mask == 0) {
        continue;
      }
      alignas(32) float squared[kFanOut];
      store(squared, distance);
      for (; mask != 0; mask &= mask - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(mask));
        const Hit hit{static_cast<std::uint32_t>(leaf * kLeafSize + block + lane), squared[lane]};
        count = insert(layout, hit, hits, count);
      }
      if (count == hits.size()) {
        limit = hits[count - 1].squared_distance;
      }
    }
  }
  return count;
}
