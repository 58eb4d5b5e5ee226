// Squared distances of a query from the boxes of a node and from the points of a leaf.
//
// A part of kdtree_query_body.hpp, whose rules hold here.

struct Query {
  Lanes x, y, z;
};

HULLTRACK_TARGET inline Query broadcast(const Point& query) {
  return {broadcast(query.x()), broadcast(query.y()), broadcast(query.z())};
}

HULLTRACK_TARGET inline Lanes squared_norm(Lanes dx, Lanes dy, Lanes dz) {
  return add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz));
}

// Distance of q from the interval [low, high]; 0 inside.
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

  // Which points are within the limit: bit i stands for point i of the leaf.
  HULLTRACK_TARGET std::uint32_t within(float limit) const {
    const Lanes l = broadcast(limit);
    return at_most(block[0], l) | (at_most(block[1], l) << 8) | (at_most(block[2], l) << 16) |
           (at_most(block[3], l) << 24);
  }
};
