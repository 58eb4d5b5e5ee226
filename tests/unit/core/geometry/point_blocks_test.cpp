#include "core/geometry/point_blocks.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <set>
#include <utility>

namespace hulltrack {
namespace {

using Coordinates = std::array<float, 3>;

Cloud random_cloud(std::size_t size) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(-50.0F, 50.0F);
  Cloud cloud(size);
  for (Point& p : cloud) {
    p = Point(u(rng), u(rng), 0.1F * u(rng));
  }
  return cloud;
}

TEST(PointBlocks, HoldEveryFinitePointOnce) {
  Cloud cloud = random_cloud(1000);  // the last block is not full
  const PointBlocks whole(cloud);
  cloud.push_back(Point::Constant(std::numeric_limits<float>::quiet_NaN()));
  const PointBlocks blocks(cloud);
  EXPECT_EQ(blocks.points(), whole.points());
  std::multiset<Coordinates> given;
  std::multiset<Coordinates> held;
  for (std::size_t i = 0; i < 1000; ++i) {
    given.insert({cloud[i].x(), cloud[i].y(), cloud[i].z()});
    held.insert({blocks.points()[i].x(), blocks.points()[i].y(), blocks.points()[i].z()});
  }
  EXPECT_EQ(given, held);
  EXPECT_TRUE(PointBlocks(Cloud{}).points().empty());
}

// Every point within range is seen, and of the others not many.
TEST(PointBlocks, PassOverOnlyWhatIsOutOfRange) {
  const Cloud cloud = random_cloud(20'000);
  const PointBlocks blocks(cloud);
  const Pose T_L_A = pose_from_xyz_rpy_deg({12.0, -7.0, 3.0}, {10.0, 20.0, -130.0});
  for (const float range : {0.0F, 3.0F, 25.0F, 200.0F}) {
    std::size_t seen = 0;
    std::size_t within = 0;
    blocks.sight_within({range}, T_L_A, [&](const Sightings& from_L, std::size_t i) {
      ++seen;
      within += from_L.point(i).norm() <= range ? 1 : 0;
    });
    std::size_t expected = 0;
    for (const Point& p : cloud) {
      expected += (T_L_A * p.cast<double>()).norm() <= range ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(within), static_cast<double>(expected), 1.0) << range;
    EXPECT_LE(seen, 2 * expected + 40 * Sightings::kBlock) << range;
  }
}

// Every point between the rows is seen, and of the others not many; at the poles as well.
TEST(PointBlocks, PassOverWhatIsAboveAndBelow) {
  const Cloud cloud = random_cloud(20'000);
  const PointBlocks blocks(cloud);
  const Pose T_L_A = pose_from_xyz_rpy_deg({2.0, -1.0, 3.0}, {10.0, 20.0, -130.0});
  constexpr std::pair<int, int> kRows[] = {{75, 104}, {0, 20}, {160, 179}, {-5, 184}, {90, 90}, {180, -1}};
  for (const auto& [lowest, highest] : kRows) {
    const auto looked_at = [&, low = lowest, high = highest](const Point& p_L) {
      const int row = SphericalGrid::cell(p_L).row;
      return row >= low && row <= high;
    };
    std::size_t seen = 0;
    std::size_t within = 0;
    blocks.sight_within({200.0F, lowest, highest}, T_L_A, [&](const Sightings& from_L, std::size_t i) {
      ++seen;
      within += looked_at(from_L.point(i)) ? 1 : 0;
    });
    std::size_t expected = 0;
    sight(blocks.points(), T_L_A, [&](std::size_t, const Sightings& from_L, std::size_t i) {
      expected += looked_at(from_L.point(i)) ? 1 : 0;
    });
    EXPECT_EQ(within, expected) << lowest << " to " << highest;
    EXPECT_LE(seen, expected + 2 * cloud.size() / 3) << lowest << " to " << highest;
  }
}

}  // namespace
}  // namespace hulltrack
