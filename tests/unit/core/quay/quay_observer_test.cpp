#include "core/quay/quay_observer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

using testing::quay_cloud;

constexpr QuayObserver::OfClass kTwenty = {20, 20, 20, 20};

const QuayMap& map() {
  static const QuayMap quay(quay_cloud());
  return quay;
}

/// `n` returns 5 cm above the quay's top.
Cloud above_the_top(int n) {
  Cloud returns_W;
  for (int i = 0; i < n; ++i) {
    returns_W.emplace_back(-15.0F + 0.05F * static_cast<float>(i), -10.0F, 0.05F);
  }
  return returns_W;
}

TEST(QuayObserver, AReturnTellsItsOffsetFromThePieceItHasMet) {
  QuayObserver observer;
  const QuayObservations& observed = observer.observe(map(), above_the_top(10), kTwenty);
  ASSERT_EQ(observed.all.size(), 10U);
  for (const QuayObservation& o : observed.all) {
    EXPECT_EQ(o.surface, SurfaceClass::horizontal);
    EXPECT_NEAR(std::abs(o.offset), 0.05, 0.01);
    EXPECT_NEAR(o.p_W.z(), 0.0, 0.01);
    EXPECT_EQ(o.age, 0U);
  }
}

TEST(QuayObserver, OfAClassNoMoreAreHeldAgainstPlanesThanItIsTold) {
  QuayObserver observer;
  EXPECT_EQ(observer.observe(map(), above_the_top(200), kTwenty).all.size(), 20U);
}

TEST(QuayObserver, ASecondIsRememberedAndOfAClassNoMoreThanTheNewest) {
  QuayObserver observer;
  for (int frame = 0; frame < 30; ++frame) {
    const QuayObservations& observed = observer.observe(map(), above_the_top(5), kTwenty);
    EXPECT_EQ(observed.all.size(), 5U * std::min<std::size_t>(frame + 1U, QuayObserver::kFrames));
    EXPECT_EQ(observed.all.front().age, std::min<std::uint32_t>(frame, QuayObserver::kFrames - 1));
  }
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_LE(observer.observe(map(), above_the_top(50), kTwenty).all.size(), QuayObserver::kOfClass);
  }
  observer.forget();
  EXPECT_TRUE(observer.observe(map(), {}, kTwenty).all.empty());
}

TEST(QuayObserver, WhatIsNearNothingObservesNothing) {
  QuayObserver observer;
  EXPECT_TRUE(observer.observe(map(), {Point(0.0F, -10.0F, 0.7F)}, kTwenty).all.empty());
  EXPECT_TRUE(observer.observe(map(), {Point(1e6F, 0.0F, 0.0F)}, kTwenty).all.empty());
  EXPECT_TRUE(observer.observe(QuayPlane{}, {Point(0.0F, 0.0F, 0.7F)}).all.empty());
  EXPECT_EQ(observer.observe(QuayPlane{}, {Point(0.0F, 0.0F, -0.3F)}).all.size(), 1U);
}

}  // namespace
}  // namespace hulltrack
