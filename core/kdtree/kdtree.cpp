#include "core/kdtree/kdtree.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/kdtree/kdtree_build.hpp"
#include "core/kdtree/kdtree_query.hpp"

namespace hulltrack {
namespace {

template <typename T>
std::size_t bytes(const LargeArray<T>& v) {
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

KdTree::KdTree(std::span<const Point> cloud, TreeUse use)
    : impl_(std::make_unique<const Impl>(
          Impl{use == TreeUse::many_searches ? kdtree::build(cloud) : kdtree::build_along_curve(cloud)})) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::optional<Neighbour> KdTree::nearest(const Point& query, float radius) const {
  kdtree::Hit hit;
  impl_->kernels.nearest(impl_->layout, {&query, 1}, kdtree::limit_below(radius), &hit);
  if (hit.slot == kdtree::kNoSlot) {
    return std::nullopt;
  }
  return Neighbour{impl_->layout.index[hit.slot], hit.squared_distance};
}

void KdTree::nearest(std::span<const Point> queries, float radius, std::span<Neighbour> out) const {
  assert(out.size() == queries.size());
  std::array<kdtree::Hit, 256> hits;
  for (std::size_t first = 0; first < queries.size(); first += hits.size()) {
    const std::size_t count = std::min(hits.size(), queries.size() - first);
    impl_->kernels.nearest(impl_->layout, queries.subspan(first, count), kdtree::limit_below(radius),
                           hits.data());
    for (std::size_t i = 0; i < count; ++i) {
      const bool found = hits[i].slot != kdtree::kNoSlot;
      out[first + i] = {found ? impl_->layout.index[hits[i].slot] : Neighbour::kNone,
                        hits[i].squared_distance};
    }
  }
}

void KdTree::nearest_k(const Point& query, std::size_t k, float radius, std::vector<Neighbour>& out) const {
  std::vector<kdtree::Hit> hits(std::min(k, size()));
  hits.resize(impl_->kernels.nearest_k(impl_->layout, query, kdtree::limit_below(radius), hits));
  out.clear();
  for (const kdtree::Hit& hit : hits) {
    out.push_back({impl_->layout.index[hit.slot], hit.squared_distance});
  }
}

void KdTree::within(const Point& query, float radius, Cloud& out) const {
  out.clear();
  const auto add = [](const kdtree::Leaf& leaf, std::uint32_t mask, void* points) {
    for (; mask != 0; mask &= mask - 1) {
      const int i = std::countr_zero(mask);
      static_cast<Cloud*>(points)->emplace_back(leaf.x[i], leaf.y[i], leaf.z[i]);
    }
  };
  impl_->kernels.within(impl_->layout, query, kdtree::limit_below(radius), add, &out);
}

void KdTree::neighbourhoods(std::span<const Point> queries, std::span<const float> radii, float margin,
                            std::span<Neighbourhood> out) const {
  assert(radii.size() == queries.size() && out.size() == queries.size());
  impl_->kernels.neighbourhoods(impl_->layout, queries, radii.data(), margin, out.data());
}

std::size_t KdTree::size() const { return impl_->layout.size; }

std::size_t KdTree::memory() const {
  const kdtree::Layout& layout = impl_->layout;
  return sizeof(Impl) + bytes(layout.nodes) + bytes(layout.first_child) + bytes(layout.leaves) +
         bytes(layout.index);
}

}  // namespace hulltrack
