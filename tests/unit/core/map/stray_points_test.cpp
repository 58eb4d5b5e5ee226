#include "core/map/stray_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hulltrack {
namespace {

/// A deck of 40 x 10 m at z = 0, a point every half metre: 81 x 21.
Cloud deck(const Point& corner = Point::Zero()) {
  Cloud cloud;
  for (int i = 0; i <= 80; ++i) {
    for (int j = 0; j <= 20; ++j) {
      cloud.push_back(corner + Point(0.5F * static_cast<float>(i), 0.5F * static_cast<float>(j), 0.0F));
    }
  }
  return cloud;
}

TEST(StrayPoints, OfAShipInOnePieceEveryPointStaysInItsPlace) {
  const Cloud ship = deck();
  Cloud cloud = ship;
  EXPECT_EQ(take_out_strays(cloud).count, 0U);
  EXPECT_EQ(cloud, ship);
}

TEST(StrayPoints, FewPointsFarAwayAreLeftOutWhereverTheyStandInTheFile) {
  const Cloud ship = deck({100.0F, 200.0F, 0.0F});
  for (const Point& stray :
       {Point(0.0F, 0.0F, 0.0F), Point(9999.0F, 9999.0F, 9999.0F), Point(120.0F, 205.0F, 90.0F)}) {
    for (const std::size_t at : {std::size_t{0}, ship.size() / 2, ship.size()}) {
      Cloud cloud = ship;
      cloud.insert(cloud.begin() + static_cast<std::ptrdiff_t>(at), stray);
      const StrayPoints strays = take_out_strays(cloud);
      EXPECT_EQ(strays.count, 1U) << stray.transpose();
      EXPECT_EQ(cloud, ship) << stray.transpose();
      const Point aside = stray - stray.cwiseMax(Point(100, 200, 0)).cwiseMin(Point(140, 210, 0));
      EXPECT_NEAR(strays.nearest, aside.norm(), 1e-2);
      EXPECT_NEAR(strays.farthest, aside.norm(), 1e-2);
    }
  }
}

TEST(StrayPoints, OnePlaceIsOnePlaceHoweverOftenItWasMeasured) {
  const Cloud ship = deck({100.0F, 200.0F, 0.0F});
  Cloud cloud = ship;
  cloud.insert(cloud.begin(), 5 * ship.size(), Point::Zero());  // firings without a return
  EXPECT_EQ(take_out_strays(cloud).count, 5 * ship.size());
  EXPECT_EQ(cloud, ship);
}

TEST(StrayPoints, WhatIsMoreThanAHundredthOfTheSurfaceStays) {
  for (const int places : {10, 40}) {  // of 1701
    Cloud cloud = deck();
    for (int i = 0; i < places; ++i) {
      cloud.emplace_back(300.0F + static_cast<float>(i), 0.0F, 0.0F);
    }
    const std::size_t all = cloud.size();
    EXPECT_EQ(take_out_strays(cloud).count, places == 10 ? 10U : 0U);
    EXPECT_EQ(cloud.size(), places == 10 ? all - 10 : all);
  }
}

TEST(StrayPoints, TwoShipsAreNoStrays) {
  Cloud cloud = deck();
  for (const Point& p : deck({8000.0F, 0.0F, 0.0F})) {
    cloud.push_back(p);
  }
  const Cloud both = cloud;
  EXPECT_EQ(take_out_strays(cloud).count, 0U);
  EXPECT_EQ(cloud, both);
}

TEST(StrayPoints, WhatIsNearerThanTheLongestHatchStays) {
  Cloud cloud = deck();
  cloud.emplace_back(20.0F, 5.0F, 24.0F);  // a crane's top
  EXPECT_EQ(take_out_strays(cloud).count, 0U);
}

}  // namespace
}  // namespace hulltrack
