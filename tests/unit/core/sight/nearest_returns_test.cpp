#include "core/sight/nearest_returns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hulltrack {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What two LiDARs saw: one of five returns is none of the hull's.
struct Seen {
  FilteredScan scan;
  std::vector<ScanView> views{2};

  explicit Seen(const std::vector<Cloud>& returns_W) {
    scan.returns_W = returns_W;
    for (const Cloud& returns : returns_W) {
      std::vector<ReturnOf>& of = scan.of.emplace_back();
      for (std::size_t i = 0; i < returns.size(); ++i) {
        of.push_back(i % 5 == 0 ? ReturnOf::surroundings : ReturnOf::hull);
        if (of.back() == ReturnOf::hull) {
          scan.hull_W.push_back(returns[i]);
        }
      }
    }
    views[0].rebuild(returns_W[0], pose_from_xyz_rpy_deg({1.0, 2.0, 3.0}, {10.0, 20.0, 30.0}));
    views[1].rebuild(returns_W[1], pose_from_xyz_rpy_deg({-4.0, 0.0, 6.0}, {180.0, 0.0, -50.0}));
  }

  void expect_as_the_tree(const Cloud& points_W) const {
    std::vector<Neighbour> expected(points_W.size());
    KdTree(scan.hull_W).nearest(points_W, kInfinity, expected);
    std::vector<double> distances;
    NearestReturns().run(points_W, views, scan, distances);
    ASSERT_EQ(distances.size(), points_W.size());
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      ASSERT_NEAR(distances[i], std::sqrt(static_cast<double>(expected[i].squared_distance)), 2e-5)
          << points_W[i].transpose();
    }
  }
};

Cloud random_cloud(std::size_t size, const Point& half, std::mt19937& random) {
  std::uniform_real_distribution<float> u(-1.0F, 1.0F);
  Cloud cloud(size);
  for (Point& p : cloud) {
    p = half.cwiseProduct(Point(u(random), u(random), u(random)));
  }
  return cloud;
}

// All around, above the poles and behind the seam of the grid; near to the sensors and far from all returns.
TEST(NearestReturns, AreThoseOfTheTree) {
  std::mt19937 random(3);
  for (const std::size_t size : {5U, 300U, 30'000U}) {
    const Point room(15.0F, 12.0F, 8.0F);
    const Seen seen({random_cloud(size, room, random), random_cloud(size, room, random)});
    for (const float around : {0.1F, 1.0F, 4.0F}) {
      ASSERT_NO_FATAL_FAILURE(seen.expect_as_the_tree(random_cloud(2000, around * room, random))) << size;
    }
  }
}

TEST(NearestReturns, AreThoseOfTheTreeAtPolesSeamAndSensor) {
  std::mt19937 random(4);
  const Seen seen(
      {random_cloud(20'000, {9.0F, 9.0F, 9.0F}, random), random_cloud(20'000, {9.0F, 9.0F, 9.0F}, random)});
  Cloud points_W;
  for (const ScanView& view : seen.views) {
    for (const Point& toward : {Point(0.0F, 0.0F, 5.0F), Point(0.0F, 0.0F, -5.0F), Point(-5.0F, 0.0F, 1.0F),
                                Point(0.0F, 0.0F, 0.0F)}) {
      for (const Point& p_L : random_cloud(300, {0.4F, 0.4F, 0.4F}, random)) {
        points_W.push_back((view.T_W_L() * (toward + p_L).cast<double>()).cast<float>());
      }
      points_W.push_back((view.T_W_L() * toward.cast<double>()).cast<float>());
    }
  }
  seen.expect_as_the_tree(points_W);
}

TEST(NearestReturns, OfNoCandidatesAreNone) {
  const Seen seen({Cloud{{1.0F, 1.0F, 1.0F}}, Cloud{}});  // the first of five: not the hull's
  std::vector<double> distances{1.0};
  NearestReturns().run(Cloud{Point::Zero()}, seen.views, seen.scan, distances);
  EXPECT_TRUE(distances.empty());
}

}  // namespace
}  // namespace hulltrack
