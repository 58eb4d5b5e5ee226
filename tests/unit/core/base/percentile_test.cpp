#include "core/base/percentile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace hulltrack {
namespace {

TEST(Percentile, EqualsNumpyOnAFixedSet) {
  // numpy 1.24: np.percentile([3, 1, 4, 1, 5, 9, 2, 6, 5, 3], [0, 25, 50, 75, 99, 100])
  std::vector<double> values{3, 1, 4, 1, 5, 9, 2, 6, 5, 3};
  EXPECT_NEAR(percentile(values, 0.0), 1.0, 1e-12);
  EXPECT_NEAR(percentile(values, 0.25), 2.25, 1e-12);
  EXPECT_NEAR(percentile(values, 0.5), 3.5, 1e-12);
  EXPECT_NEAR(percentile(values, 0.75), 5.0, 1e-12);
  EXPECT_NEAR(percentile(values, 0.99), 8.73, 1e-12);
  EXPECT_NEAR(percentile(values, 1.0), 9.0, 1e-12);
}

TEST(Percentile, EqualsASortedInterpolation) {
  std::mt19937 random(7);
  std::exponential_distribution<double> distance(4.0);
  for (std::size_t n = 1; n < 60; ++n) {
    std::vector<double> values(n);
    for (double& v : values) {
      v = distance(random);
    }
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const double p : {0.0, 0.1, 0.25, 0.5, 0.75, 0.99, 1.0}) {
      const double rank = p * static_cast<double>(n - 1);
      const auto low = static_cast<std::size_t>(std::floor(rank));
      const auto high = static_cast<std::size_t>(std::ceil(rank));
      const double expected = sorted[low] + (rank - std::floor(rank)) * (sorted[high] - sorted[low]);
      EXPECT_NEAR(percentile(values, p), expected, 1e-12) << n << ' ' << p;
    }
  }
}

TEST(Percentile, OfNothingIsZero) { EXPECT_EQ(percentile({}, 0.5), 0.0); }

}  // namespace
}  // namespace hulltrack
