#include "core/search/kdtree.hpp"

#include <algorithm>
#include <cmath>

namespace hulltrack {

struct KdTree::Impl {
  std::vector<Point> points;
};

KdTree::KdTree(std::span<const Point> cloud)
    : impl_(std::make_unique<const Impl>(Impl{{cloud.begin(), cloud.end()}})) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::optional<Neighbour> KdTree::nearest(const Point& query, float radius) const {
  std::optional<Neighbour> best;
  float limit = radius * radius;
  for (std::size_t i = 0; i < impl_->points.size(); ++i) {
    const float d2 = (impl_->points[i] - query).squaredNorm();
    if (d2 < limit) {
      limit = d2;
      best = Neighbour{static_cast<std::uint32_t>(i), d2};
    }
  }
  return best;
}

void KdTree::nearest_k(const Point&, std::size_t, float, std::vector<Neighbour>& out) const { out.clear(); }

std::size_t KdTree::size() const { return impl_->points.size(); }

}  // namespace hulltrack
