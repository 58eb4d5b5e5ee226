#include "core/search/kdtree.hpp"

#include <cmath>
#include <limits>

#include "core/search/kdtree_build.hpp"
#include "core/search/kdtree_query.hpp"

namespace hulltrack {
namespace {

// The largest float below radius^2: "distance < radius" as the kernels' "<= limit".
float limit_below(float radius) { return radius > 0.0F ? std::nextafter(radius * radius, 0.0F) : -1.0F; }

template <typename T>
std::size_t bytes(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace

struct KdTree::Impl {
  kdtree::Layout layout;
  const kdtree::Kernels& kernels = kdtree::best_kernels();
};

namespace kdtree {

const Kernels& best_kernels() { return avx2_available() ? avx2_kernels() : sse2_kernels(); }

}  // namespace kdtree

KdTree::KdTree(std::span<const Point> cloud)
    : impl_(std::make_unique<const Impl>(Impl{kdtree::build(cloud)})) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::optional<Neighbour> KdTree::nearest(const Point& query, float radius) const {
  kdtree::Hit hit;
  if (!impl_->kernels.nearest(impl_->layout, query, limit_below(radius), hit)) {
    return std::nullopt;
  }
  return Neighbour{impl_->layout.index[hit.slot], hit.squared_distance};
}

void KdTree::nearest_k(const Point& query, std::size_t k, float radius, std::vector<Neighbour>& out) const {
  std::vector<kdtree::Hit> hits(std::min(k, size()));
  hits.resize(impl_->kernels.nearest_k(impl_->layout, query, limit_below(radius), hits));
  out.clear();
  for (const kdtree::Hit& hit : hits) {
    out.push_back({impl_->layout.index[hit.slot], hit.squared_distance});
  }
}

void KdTree::neighbourhood(const Point& query, float radius, Neighbourhood& out) const {
  std::array<kdtree::Hit, Neighbourhood::kCapacity> hits;
  const std::size_t count = impl_->kernels.nearest_k(impl_->layout, query, limit_below(radius), hits);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  out.x.fill(kInfinity);
  out.y.fill(kInfinity);
  out.z.fill(kInfinity);
  for (std::size_t i = 0; i < count; ++i) {
    const kdtree::Leaf& leaf = impl_->layout.leaves[hits[i].slot / kdtree::kLeafSize];
    const std::size_t position = hits[i].slot % kdtree::kLeafSize;
    out.x[i] = leaf.x[position];
    out.y[i] = leaf.y[position];
    out.z[i] = leaf.z[position];
    out.index[i] = impl_->layout.index[hits[i].slot];
  }
  out.count = static_cast<std::uint32_t>(count);
  out.clear_radius = count == hits.size() ? std::sqrt(hits.back().squared_distance) : radius;
}

std::size_t KdTree::size() const { return impl_->layout.size; }

std::size_t KdTree::memory() const {
  const kdtree::Layout& layout = impl_->layout;
  return sizeof(Impl) + bytes(layout.nodes) + bytes(layout.first_child) + bytes(layout.leaves) +
         bytes(layout.index);
}

}  // namespace hulltrack
