#include "core/quay/quay_top.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/geometry/cloud.hpp"
#include "core/geometry/se3.hpp"
#include "core/witness/top_learner.hpp"

namespace hulltrack {
namespace {

/// `count` returns on a plane over x in [-20, 20] and y in [-15, -1], 2 cm of noise.
Cloud returns_on(const QuayPlane& plane, int count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(-20.0, 20.0);
  std::uniform_real_distribution<double> y(-15.0, -1.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  Cloud cloud;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at(x(random), y(random));
    const double z = plane.height + std::tan(plane.slope.x()) * at.x() + std::tan(plane.slope.y()) * at.y();
    cloud.push_back(Eigen::Vector3d(at.x(), at.y(), z + noise(random)).cast<float>());
  }
  return cloud;
}

QuayPlane level(double height) { return {height, Eigen::Vector2d::Zero()}; }

const Box kHull{{-90.0F, 0.0F, -10.0F}, {90.0F, 40.0F, 20.0F}};

/// Lorries, stacks and people: anywhere above.
void add_clutter(Cloud& cloud, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> x(-20.0F, 20.0F);
  std::uniform_real_distribution<float> y(-15.0F, -1.0F);
  std::uniform_real_distribution<float> z(0.2F, 6.0F);
  for (int i = 0; i < count; ++i) {
    cloud.emplace_back(x(random), y(random), z(random));
  }
}

TEST(FindQuayTop, FindsAnyQuaysTopBesideWhatStandsOnIt) {
  for (const double height : {-3.0, 0.0, 4.2}) {
    for (const Eigen::Vector2d& slope_deg :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.3, -1.5), Eigen::Vector2d(-4.5, 4.5)}) {
      const QuayPlane truth{height, slope_deg * radians(1.0)};
      Cloud returns_W = returns_on(truth, 1500);
      add_clutter(returns_W, 1000);
      const auto found = find_quay_top(returns_W);
      ASSERT_TRUE(found) << height << " " << slope_deg.transpose();
      EXPECT_NEAR(found->plane.height, height, 0.02);
      EXPECT_NEAR(degrees((found->plane.slope - truth.slope).norm()), 0.0, 0.15);
      EXPECT_LT(degrees(found->sigma_slope), 0.35);
      EXPECT_NEAR(found->area_W.min.y(), -14.3F, 0.4F) << "one in twenty beyond";
      EXPECT_NEAR(found->middle_W.y(), -8.0, 0.5);
    }
  }
}

TEST(FindQuayTop, KnowsTheSlopeOfAnUnevenQuayWorse) {
  Cloud even = returns_on({}, 1500);
  Cloud uneven = even;
  for (Point& p : uneven) {
    p.z() += 0.05F * std::sin(p.x() / 3.0F);
  }
  EXPECT_GT(find_quay_top(uneven)->sigma_slope, 2.0 * find_quay_top(even)->sigma_slope);
}

TEST(FindQuayTop, SaysNothingWhereNoPlaneHasMostReturns) {
  Cloud returns_W = returns_on({}, 1000);
  add_clutter(returns_W, 1500);
  EXPECT_FALSE(find_quay_top(returns_W));
  EXPECT_FALSE(find_quay_top(returns_on({}, 200))) << "too few";
  EXPECT_FALSE(find_quay_top({}));
}

TEST(FindQuayTop, SaysNothingOfAStripThatTellsNoSlopeOrOfARamp) {
  Cloud strip = returns_on({}, 2000);
  for (Point& p : strip) {
    p.y() *= 0.2F;
  }
  EXPECT_FALSE(find_quay_top(strip));
  EXPECT_FALSE(find_quay_top(returns_on({0.0, {radians(9.0), 0.0}}, 2000)));
}

TEST(FindQuayTop, EqualOrWildReturnsAreNoTop) {
  EXPECT_FALSE(find_quay_top(Cloud(1000, Point(1.0F, 2.0F, 3.0F))));
  Cloud far(1000, Point(1e30F, -1e30F, 1e30F));
  far.front() = Point::Zero();
  EXPECT_FALSE(find_quay_top(far));
}

TEST(TopLearner, FindsTheTopAfterTwoSecondsOnTheLoadersSideOfTheBerth) {
  TopLearner learner(kHull, -8.0);
  Cloud frame = returns_on({}, 100);
  for (const Point& p : returns_on(level(6.0), 200, 2)) {  // her deck: more returns than the quay
    frame.emplace_back(p.x(), p.y() + 20.0F, p.z());
    frame.emplace_back(p.x(), p.y() + 56.0F, p.z());  // and that of a barge alongside
    frame.emplace_back(p.x(), p.y() - 20.0F, p.z());  // and of a ship behind the jetty
  }
  for (int i = 1; i <= TopLearner::kFrames; ++i) {
    EXPECT_FALSE(learner.top());
    learner.add(frame, {});
  }
  ASSERT_TRUE(learner.top());
  EXPECT_NEAR(learner.top()->seen.plane.height, 0.0, 0.02);
}

TEST(TopLearner, TheLoaderMayStandOnTheOtherSideButNotWhereTheShipLies) {
  for (const auto& [rails_y, found] :
       {std::pair(50.0, true), std::pair(20.0, false), std::pair(-8.0, false)}) {
    TopLearner learner(kHull, rails_y);
    Cloud frame;
    for (const Point& p : returns_on(level(2.0), 100)) {
      frame.emplace_back(p.x(), p.y() + 56.0F, p.z());
    }
    MachineStand stand;
    stand.sensor_W = {0.0, 30.0, 25.0};
    for (int i = 0; i < TopLearner::kFrames; ++i) {
      learner.add(frame, stand);
    }
    EXPECT_EQ(learner.top().has_value(), found) << rails_y;
  }
}

TEST(TopLearner, LooksForAnotherOneWhenItIsNotSeenForLongAndKeepsTheFirstForPeople) {
  TopLearner learner(kHull, -8.0);
  const auto learn = [&](double height) {
    for (int i = 0; i < TopLearner::kFrames; ++i) {
      learner.add(returns_on(level(height), 100), {});
    }
  };
  learn(0.0);
  for (int i = 1; i < TopLearner::kMisses; ++i) {
    learner.seen(false);
  }
  learner.seen(true);
  EXPECT_TRUE(learner.top());
  for (int i = 0; i < TopLearner::kMisses; ++i) {
    learner.seen(false);
  }
  EXPECT_FALSE(learner.top());
  learn(1.0);
  ASSERT_TRUE(learner.top());
  EXPECT_NEAR(learner.top()->seen.plane.height, 1.0, 0.02);
  EXPECT_NEAR(learner.first()->plane.height, 0.0, 0.02);
  learner.forget();
  EXPECT_FALSE(learner.top());
  EXPECT_FALSE(learner.first()) << "it was seen with joints that have been mended since";
}

}  // namespace
}  // namespace hulltrack
