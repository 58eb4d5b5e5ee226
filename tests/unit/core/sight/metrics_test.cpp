#include "core/sight/metrics.hpp"

#include <gtest/gtest.h>

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

TEST(Metrics, NoDistancesGiveNoFigures) {
  std::vector<double> none;
  EXPECT_FALSE(summarise_distances(none).valid);
}

}  // namespace
}  // namespace hulltrack
