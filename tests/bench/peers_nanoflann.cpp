#include <cmath>
#include <limits>
#include <nanoflann.hpp>

#include "core/registration/rigid_fit.hpp"
#include "tests/bench/peers.hpp"

namespace hulltrack::bench {
namespace {

constexpr std::size_t kLeafMax = 10;  // nanoflann's default

struct Adaptor {
  const Cloud& cloud;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return cloud.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return cloud[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

// A result set for the one nearest point within a radius: the search is bounded from the start.
class Nearest {
 public:
  explicit Nearest(float squared_radius) : best_{Neighbour::kNone, squared_radius} {}
  [[nodiscard]] std::size_t size() const { return best_.index == Neighbour::kNone ? 0 : 1; }
  [[nodiscard]] bool full() const { return true; }
  [[nodiscard]] float worstDist() const { return best_.squared_distance; }
  bool addPoint(float squared_distance, std::uint32_t index) {
    if (squared_distance < best_.squared_distance) {
      best_ = {index, squared_distance};
    }
    return true;
  }
  [[nodiscard]] const Neighbour& best() const { return best_; }

 private:
  Neighbour best_;
};

}  // namespace

struct NanoflannTree::Impl {
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3>;
  explicit Impl(const Cloud& cloud)
      : adaptor{cloud}, tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafMax)) {
    tree.buildIndex();
  }
  [[nodiscard]] Neighbour nearest(const Point& query, float radius) const {
    Nearest result(radius * radius);
    tree.findNeighbors(result, query.data(), nanoflann::SearchParams());
    return result.best();
  }
  Adaptor adaptor;
  Tree tree;
};

NanoflannTree::NanoflannTree(const Cloud& cloud) : impl_(std::make_unique<Impl>(cloud)) {}
NanoflannTree::~NanoflannTree() = default;

void NanoflannTree::nearest(std::span<const Point> queries, float radius, std::span<Neighbour> out) const {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    out[i] = impl_->nearest(queries[i], radius);
  }
}

IcpResult NanoflannTree::align(std::span<const Point> source, const Pose& T_init,
                               const IcpConfig& config) const {
  IcpResult result;
  result.T_target_source = T_init;
  const auto gate = static_cast<float>(config.max_correspondence_distance);
  while (result.iterations < config.max_iterations && !result.converged) {
    std::optional<RigidFit> fit;
    const Eigen::Matrix3d R = result.T_target_source.linear();
    const Eigen::Vector3d t = result.T_target_source.translation();
    for (const Point& p : source) {
      const Eigen::Vector3d place = R * p.cast<double>() + t;
      const Neighbour nearest = impl_->nearest(place.cast<float>(), gate);
      if (nearest.index != Neighbour::kNone) {
        const Eigen::Vector3d target = impl_->adaptor.cloud[nearest.index].cast<double>();
        if (!fit) {
          fit.emplace(target);
        }
        fit->add(place, target);
      }
    }
    ++result.iterations;
    const auto motion = fit ? fit->solve() : std::nullopt;
    if (!motion) {
      break;
    }
    result.matched = fit->pairs();
    result.T_target_source = motion->pose() * result.T_target_source;
    result.converged = motion->translation.norm() < config.translation_epsilon &&
                       rotation_angle(motion->rotation) < config.rotation_epsilon;
  }
  return result;
}

}  // namespace hulltrack::bench
