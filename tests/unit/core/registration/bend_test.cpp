#include "core/registration/bend.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

TEST(BendShape, RisesByNothingAtTheReferencePointAndByOneHalfALengthAway) {
  const BendShape shape{12.0, 180.0};
  EXPECT_DOUBLE_EQ(shape.rise(12.0), 0.0);
  EXPECT_DOUBLE_EQ(shape.rise(12.0 + 90.0), 1.0);
  EXPECT_DOUBLE_EQ(shape.rise(12.0 - 90.0), 1.0);
}

TEST(BendShape, IsTheParabolaOfTheHullUpToARigidMotionWhereverItIsReferredTo) {
  // u(x) = -(1 - (2 x / L)^2) about amidships: what is left beside the rise is a height and a slope.
  constexpr double kLength = 180.0;
  for (const double reference : {-70.0, 0.0, 35.0}) {
    const BendShape shape{reference, kLength};
    const auto beside = [&](double x) {
      const double s = 2.0 * x / kLength;
      return -(1.0 - s * s) - shape.rise(x);
    };
    const double slope = (beside(90.0) - beside(-90.0)) / kLength;
    for (double x = -90.0; x <= 90.0; x += 7.5) {
      EXPECT_NEAR(beside(x), beside(0.0) + slope * x, 1e-12) << reference << ", " << x;
    }
  }
}

}  // namespace
}  // namespace hulltrack
