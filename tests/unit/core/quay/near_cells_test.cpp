#include "core/quay/near_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/kdtree/kdtree.hpp"

namespace hulltrack {
namespace {

constexpr float kCell = NearCells::kCell;

/// `x` by `y` metres of level ground from the origin on, a point each 10 cm.
Cloud ground(float x, float y) {
  Cloud cloud;
  for (float i = 0.0F; i < x; i += 0.1F) {
    for (float j = 0.0F; j < y; j += 0.1F) {
      cloud.emplace_back(i, j, 0.05F);
    }
  }
  return cloud;
}

TEST(NearCells, WhatLiesACellAsideIsNearAndWhatLiesBeyondThreeIsNot) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-6.0F, 6.0F);
  std::uniform_real_distribution<float> aside(-kCell, kCell);
  Cloud points;
  for (int i = 0; i < 200; ++i) {
    points.emplace_back(place(random), place(random), place(random));
  }
  const NearCells cells(points);
  for (const Point& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      Point off(aside(random), aside(random), aside(random));
      off[axis] = 0.0F;
      EXPECT_TRUE(cells.at(p + off).near) << p.transpose() << " off by " << off.transpose();
    }
  }
  const KdTree tree(points);
  int near = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Point p(place(random), place(random), place(random));
    if (cells.at(p).near) {
      ++near;
      EXPECT_TRUE(tree.nearest(p, 3.0F * kCell + 1e-4F)) << p.transpose();
    }
  }
  EXPECT_GT(near, 100);
}

TEST(NearCells, InsideALevelSurfaceItGoesOnToAllSides) {
  const NearCells cells(ground(10.0F, 6.0F));
  EXPECT_TRUE(cells.at({5.0F, 3.0F, 0.0F}).inside_level);
  for (const Point& edge :
       {Point(0.3F, 3.0F, 0.0F), Point(9.7F, 3.0F, 0.0F), Point(5.0F, 0.3F, 0.0F), Point(5.0F, 5.7F, 0.0F)}) {
    EXPECT_TRUE(cells.at(edge).near) << edge.transpose();
    EXPECT_FALSE(cells.at(edge).inside_level) << edge.transpose();
  }
  EXPECT_FALSE(cells.at({5.0F, 3.0F, 1.0F}).near);
  EXPECT_FALSE(cells.at({5.0F, 3.0F, 1.0F}).inside_level);
}

TEST(NearCells, AWallIsNoLevelSurface) {
  Cloud wall;
  for (const Point& p : ground(10.0F, 6.0F)) {
    wall.emplace_back(p.x(), p.z(), p.y());
  }
  const NearCells cells(wall);
  EXPECT_TRUE(cells.at({5.0F, 0.0F, 3.0F}).near);
  EXPECT_FALSE(cells.at({5.0F, 0.0F, 3.0F}).inside_level);
}

TEST(NearCells, ItReachesAsFarAsThereIsAnythingAboveOrBeneath) {
  const NearCells cells(ground(10.0F, 6.0F));
  EXPECT_TRUE(cells.in_reach({5.0F, 3.0F, 40.0F}));
  EXPECT_TRUE(cells.in_reach({5.0F, 3.0F, -40.0F}));
  EXPECT_FALSE(cells.in_reach({12.0F, 3.0F, 0.0F}));
}

TEST(NearCells, FarAwayAndNowhereThereIsNothing) {
  const Cloud points = {{1e9F, 0.0F, 0.0F}, {-99'999.0F, 99'999.0F, 3.0F}};
  const NearCells cells(points);
  EXPECT_TRUE(cells.at(points[1]).near);
  for (const Point& p :
       {points[0], Point(0.0F, 0.0F, 0.0F), Point(Point::Constant(std::numeric_limits<float>::quiet_NaN())),
        Point(Point::Constant(std::numeric_limits<float>::infinity()))}) {
    EXPECT_FALSE(cells.at(p).near);
    EXPECT_FALSE(cells.at(p).inside_level);
    EXPECT_FALSE(cells.in_reach(p));
  }
}

}  // namespace
}  // namespace hulltrack
