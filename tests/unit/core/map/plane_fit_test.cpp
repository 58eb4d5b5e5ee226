#include "core/map/plane_fit.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/geometry/se3.hpp"

namespace hulltrack {
namespace {

using Eigen::Vector3d;

TEST(PlaneFit, OfAPlateIsItsPlaneAndHalfItsExtentsOverRootThree) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.005);
  const Eigen::Matrix3d R = rotation_from_rpy({0.4, -0.7, 1.9});
  const Vector3d middle(80.0, -12.0, 7.0);
  Cloud cloud;
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d p(0.3 * unit(random), 0.1 * unit(random), noise(random));
    cloud.push_back((middle + R * p).cast<float>());
  }
  const Point beside = (middle + R * Vector3d(0.05, 0.02, 0.01)).cast<float>();
  const PlaneFit fit = fit_plane(beside, cloud);
  EXPECT_LT((fit.centroid - R * Vector3d(-0.05, -0.02, -0.01)).norm(), 0.005) << "from the point";
  EXPECT_GT(std::abs(fit.normal.dot(R.col(2))), std::cos(radians(0.5)));
  EXPECT_NEAR(fit.normal.norm(), 1.0, 1e-9);
  EXPECT_NEAR(fit.spread[0], 0.005, 0.0002);
  EXPECT_NEAR(fit.spread[1], 0.1 / std::sqrt(3.0), 0.001);
  EXPECT_NEAR(fit.spread[2], 0.3 / std::sqrt(3.0), 0.003);
}

TEST(PlaneFit, OfOnePointHasNoSpread) {
  const Cloud cloud{{1.0F, 2.0F, 3.0F}};
  const PlaneFit fit = fit_plane({1.0F, 2.0F, 2.5F}, cloud);
  EXPECT_EQ(fit.centroid, Vector3d(0.0, 0.0, 0.5));
  for (const double spread : fit.spread) {
    EXPECT_EQ(spread, 0.0);
  }
  EXPECT_NEAR(fit.normal.norm(), 1.0, 1e-9);
}

}  // namespace
}  // namespace hulltrack
