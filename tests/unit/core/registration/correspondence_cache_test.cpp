#include "core/registration/correspondence_cache.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hulltrack {
namespace {

constexpr double kGate = 0.3;

// A noisy plane on a grid of 5 cm with the last quarter of `source` far above it.
struct Plane {
  Cloud target;
  Cloud source;

  Plane() {
    std::mt19937 rng(1);
    std::normal_distribution<float> noise(0.0F, 0.01F);
    for (int i = 0; i < 120; ++i) {
      for (int k = 0; k < 120; ++k) {
        target.emplace_back(0.05F * static_cast<float>(i), 0.05F * static_cast<float>(k), noise(rng));
      }
    }
    std::uniform_real_distribution<float> u(0.0F, 6.0F);
    for (int i = 0; i < 400; ++i) {
      source.emplace_back(u(rng), u(rng), i < 300 ? noise(rng) : 1.0F + u(rng));
    }
  }
};

Pose shifted(double x, double z) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(x, 0.0, z);
  return T;
}

void expect_fresh(CorrespondenceCache& cache, const Cloud& source, const Cloud& target, const KdTree& tree,
                  const Pose& T) {
  const auto pairs = cache.find(T);
  std::size_t at = 0;
  for (const Point& p : source) {
    const Eigen::Vector3d place = T.linear() * p.cast<double>() + T.translation();
    const auto nearest = tree.nearest(place.cast<float>(), static_cast<float>(kGate));
    if (nearest) {
      ASSERT_LT(at, pairs.size());
      EXPECT_EQ(pairs[at].source, place);
      EXPECT_EQ(pairs[at].target, target[nearest->index].cast<double>());
      EXPECT_EQ(pairs[at].distance, std::sqrt(static_cast<double>(nearest->squared_distance)));
      ++at;
    }
  }
  EXPECT_EQ(at, pairs.size());
}

TEST(CorrespondenceCache, EqualsAFreshSearchAtEveryStep) {
  const Plane plane;
  const KdTree tree(plane.target);
  CorrespondenceCache cache(kGate);
  cache.reset(plane.source, tree);
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int step = 0; step < 60; ++step) {
    const double size = step % 15 == 0 ? 0.4 : 0.01;  // small steps and now and then a large one
    expect_fresh(cache, plane.source, plane.target, tree, shifted(size * u(rng), size * u(rng)));
  }
}

// Far from the origin, where floats are coarse, a plane sinks onto the other and turns: points that had no
// partner for many steps must get theirs at the very step at which they come within the gate.
TEST(CorrespondenceCache, EqualsAFreshSearchAsCloudsMeetFarFromTheOrigin) {
  Plane plane;
  const Point far(310.0F, -240.0F, 35.0F);
  for (Point& p : plane.target) {
    p += far;
  }
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> height(0.2F, 1.2F);
  for (Point& p : plane.source) {
    p = far + Point(p.x(), p.y(), height(rng));
  }
  plane.source.push_back(Point::Constant(std::numeric_limits<float>::quiet_NaN()));
  const KdTree tree(plane.target);
  CorrespondenceCache cache(kGate);
  cache.reset(plane.source, tree);
  const Eigen::Vector3d centre = far.cast<double>() + Eigen::Vector3d(3.0, 3.0, 0.0);
  for (int step = 0; step < 150; ++step) {
    const Eigen::Vector3d down(0.0, 0.0, -0.007 * step);
    const Eigen::AngleAxisd turn(2e-4 * step, Eigen::Vector3d(1.0, 2.0, 2.0).normalized());
    const Pose T = Eigen::Translation3d(centre + down) * turn * Eigen::Translation3d(-centre);
    expect_fresh(cache, plane.source, plane.target, tree, T);
  }
  EXPECT_LT(cache.searches(), plane.source.size() * 150 / 5);
}

TEST(CorrespondenceCache, SearchesNoMoreWhenTheSourceHardlyMoves) {
  const Plane plane;
  const KdTree tree(plane.target);
  CorrespondenceCache cache(kGate);
  cache.reset(plane.source, tree);
  (void)cache.find(shifted(0.05, 0.05));
  (void)cache.find(shifted(0.0, 0.0));
  const std::size_t before = cache.searches();
  for (int step = 1; step <= 10; ++step) {
    (void)cache.find(shifted(1e-4 * step, 0.0));
  }
  EXPECT_LT(cache.searches() - before, plane.source.size() / 20);
}

}  // namespace
}  // namespace hulltrack
