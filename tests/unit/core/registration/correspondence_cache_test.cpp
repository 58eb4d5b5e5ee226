#include "core/registration/correspondence_cache.hpp"

#include <gtest/gtest.h>

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

TEST(CorrespondenceCache, EqualsAFreshSearchAtEveryStep) {
  const Plane plane;
  const KdTree tree(plane.target);
  CorrespondenceCache cache(kGate);
  cache.reset(plane.source, tree);
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int step = 0; step < 60; ++step) {
    const double size = step % 15 == 0 ? 0.4 : 0.01;  // small steps and now and then a large one
    const Pose T = shifted(size * u(rng), size * u(rng));
    const auto pairs = cache.find(T);
    std::size_t at = 0;
    for (const Point& p : plane.source) {
      const Eigen::Vector3d place = T.linear() * p.cast<double>() + T.translation();
      const auto nearest = tree.nearest(place.cast<float>(), static_cast<float>(kGate));
      if (nearest) {
        ASSERT_LT(at, pairs.size());
        EXPECT_EQ(pairs[at].source, place);
        EXPECT_EQ(pairs[at].target, plane.target[nearest->index].cast<double>());
        EXPECT_EQ(pairs[at].distance, std::sqrt(static_cast<double>(nearest->squared_distance)));
        ++at;
      }
    }
    EXPECT_EQ(at, pairs.size());
  }
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
