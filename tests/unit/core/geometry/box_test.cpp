#include "core/geometry/box.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

TEST(Box, OfNoPointsHoldsNothingAndGrowsToTheFirst) {
  Box box = Box::none();
  EXPECT_FALSE(box.contains(Point::Zero()));
  EXPECT_EQ(box.diagonal(), 0.0F);
  box.add({1.0F, -2.0F, 3.0F});
  EXPECT_EQ(box.min, Point(1.0F, -2.0F, 3.0F));
  EXPECT_EQ(box.max, box.min);
  EXPECT_EQ(box.diagonal(), 0.0F);
  box.add({4.0F, 2.0F, 3.0F});
  EXPECT_FLOAT_EQ(box.diagonal(), 5.0F);
  EXPECT_TRUE(box.contains({2.0F, 0.0F, 3.0F}));
}

TEST(Box, AroundPointsIsTight) {
  const Cloud points = {{0.0F, 5.0F, -1.0F}, {2.0F, -5.0F, 0.0F}};
  const Box box = bounding_box(points);
  EXPECT_EQ(box.min, Point(0.0F, -5.0F, -1.0F));
  EXPECT_EQ(box.max, Point(2.0F, 5.0F, 0.0F));
}

}  // namespace
}  // namespace hulltrack
