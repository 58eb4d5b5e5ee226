#include "core/filter/voxel_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace hulltrack {
namespace {

Cloud random_cloud(std::size_t size, float extent, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> u(-extent, extent);
  Cloud cloud(size);
  for (Point& p : cloud) {
    p = Point(u(rng), u(rng), 0.2F * u(rng));
  }
  return cloud;
}

// The rule in its plainest form: group by voxel in an ordered map, then look at every point of a group.
std::vector<std::uint32_t> plain_selection(const Cloud& cloud, double size) {
  std::map<std::array<int, 3>, std::vector<std::uint32_t>> voxels;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d cell = (cloud[i].cast<double>() / size).array().floor();
    voxels[{static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())}].push_back(i);
  }
  std::map<std::uint32_t, std::uint32_t> by_first;
  for (const auto& [cell, members] : voxels) {
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    for (const std::uint32_t i : members) {
      centroid += cloud[i].cast<double>() / static_cast<double>(members.size());
    }
    by_first[members.front()] =
        *std::min_element(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
          return (cloud[a].cast<double>() - centroid).norm() < (cloud[b].cast<double>() - centroid).norm();
        });
  }
  std::vector<std::uint32_t> selection;
  for (const auto& [first, representative] : by_first) {
    selection.push_back(representative);
  }
  return selection;
}

TEST(VoxelFilter, EqualsGroupingByAnOrderedMap) {
  VoxelFilter filter(0.5);
  for (const unsigned seed : {1U, 2U, 3U}) {  // also: the second call is not disturbed by the first
    const Cloud cloud = random_cloud(20000 / seed, 12.0F, seed);
    const auto selected = filter.select(cloud);
    EXPECT_EQ(std::vector<std::uint32_t>(selected.begin(), selected.end()), plain_selection(cloud, 0.5));
  }
}

TEST(VoxelFilter, KeepsRealPointsOneAVoxel) {
  const Cloud cloud = random_cloud(5000, 5.0F, 4);
  Cloud thinned;
  VoxelFilter(0.25).filter(cloud, thinned);
  std::map<std::array<float, 3>, int> voxels;
  for (const Point& p : thinned) {
    EXPECT_NE(std::find(cloud.begin(), cloud.end(), p), cloud.end());
    EXPECT_EQ(++voxels[(std::array{std::floor(p.x() * 4), std::floor(p.y() * 4), std::floor(p.z() * 4)})], 1);
  }
}

TEST(VoxelFilter, DoesNotLeanTowardsTheGrid) {
  // A noisy deck at any height within its voxels: the representatives' mean height is the deck's.
  std::mt19937 rng(5);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  for (const float height : {0.05F, 0.15F, 0.35F, 0.45F}) {
    Cloud deck = random_cloud(40000, 15.0F, 6);
    for (Point& p : deck) {
      p.z() = height + std::clamp(noise(rng), -0.045F, 0.045F);
    }
    Cloud thinned;
    VoxelFilter(0.5).filter(deck, thinned);
    double mean = 0.0;
    for (const Point& p : thinned) {
      mean += static_cast<double>(p.z()) / static_cast<double>(thinned.size());
    }
    EXPECT_NEAR(mean, height, 4.0 * 0.02 / std::sqrt(static_cast<double>(thinned.size())));
  }
}

TEST(VoxelFilter, LeavesOutWhatHasNoVoxel) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const Cloud cloud{{nan, 0, 0}, {0, inf, 0}, {0, 0, -inf}, {1e9F, 0, 0}, {0.1F, 0.1F, 0.1F}, {0, nan, 0}};
  VoxelFilter filter(0.5);
  const auto selected = filter.select(cloud);
  ASSERT_EQ(selected.size(), 1U);
  EXPECT_EQ(selected[0], 4U);
  EXPECT_TRUE(filter.select(Cloud{}).empty());
}

TEST(VoxelFilter, TakesTheFirstOfEqualPoints) {
  const Cloud cloud(10, Point(0.2F, 0.2F, 0.2F));
  VoxelFilter filter(0.5);
  const auto selected = filter.select(cloud);
  ASSERT_EQ(selected.size(), 1U);
  EXPECT_EQ(selected[0], 0U);
}

}  // namespace
}  // namespace hulltrack
