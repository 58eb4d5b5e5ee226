#include "core/tracking/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hulltrack {
namespace {

TEST(Metrics, EqualNumpyOnAFixedSet) {
  // numpy 1.24: d = [3, 1, 4, 1, 5, 9, 2, 6, 5, 3]; np.percentile(d, [25, 50, 75]), d.mean(),
  // sqrt((d**2).mean())
  std::vector<double> d{3, 1, 4, 1, 5, 9, 2, 6, 5, 3};
  const DistanceMetrics m = summarise_distances(d);
  EXPECT_TRUE(m.valid);
  EXPECT_EQ(m.points, 10u);
  EXPECT_NEAR(m.q1, 2.25, 1e-12);
  EXPECT_NEAR(m.median, 3.5, 1e-12);
  EXPECT_NEAR(m.q3, 5.0, 1e-12);
  EXPECT_NEAR(m.mean, 3.9, 1e-12);
  EXPECT_NEAR(m.rms, 4.5497252664309302, 1e-12);
}

TEST(Metrics, PercentilesEqualASortedInterpolation) {
  std::mt19937 random(7);
  std::exponential_distribution<double> distance(4.0);
  for (std::size_t n = 1; n < 60; ++n) {
    std::vector<double> d(n);
    for (double& v : d) {
      v = distance(random);
    }
    std::vector<double> sorted = d;
    std::sort(sorted.begin(), sorted.end());
    const auto expected = [&](double p) {
      const double rank = p * static_cast<double>(n - 1);
      const auto low = static_cast<std::size_t>(std::floor(rank));
      const auto high = static_cast<std::size_t>(std::ceil(rank));
      return sorted[low] + (rank - std::floor(rank)) * (sorted[high] - sorted[low]);
    };
    const DistanceMetrics m = summarise_distances(d);
    EXPECT_NEAR(m.q1, expected(0.25), 1e-12) << n;
    EXPECT_NEAR(m.median, expected(0.5), 1e-12) << n;
    EXPECT_NEAR(m.q3, expected(0.75), 1e-12) << n;
  }
}

TEST(Metrics, NoDistancesGiveNoFigures) {
  std::vector<double> none;
  EXPECT_FALSE(summarise_distances(none).valid);
}

}  // namespace
}  // namespace hulltrack
