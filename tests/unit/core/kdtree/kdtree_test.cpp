#include "core/kdtree/kdtree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <set>

#include "core/kdtree/kdtree_build.hpp"
#include "core/kdtree/kdtree_query.hpp"

namespace hulltrack {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

float squared_distance(const Point& a, const Point& b) {
  const Point d = a - b;
  return (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z();
}

// All points with distance < radius in the order that the tree promises.
std::vector<Neighbour> brute_force(const Cloud& cloud, const Point& query, float radius) {
  std::vector<Neighbour> found;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const float d2 = squared_distance(cloud[i], query);
    if (d2 < radius * radius) {
      found.push_back({i, d2});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.squared_distance < b.squared_distance; });
  return found;
}

Cloud random_cloud(std::size_t size, const Point& extent, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> u(-0.5F, 0.5F);
  Cloud cloud(size);
  for (Point& p : cloud) {
    p = Point(u(rng), u(rng), u(rng)).cwiseProduct(extent);
  }
  return cloud;
}

// Walls and decks on a grid: many equal coordinates and equal distances.
Cloud grid_cloud(std::size_t size, unsigned seed) {
  Cloud cloud = random_cloud(size, Point(12.0F, 8.0F, 3.0F), seed);
  for (Point& p : cloud) {
    p = (p * 4.0F).array().round().matrix() / 4.0F;
  }
  return cloud;
}

// What a neighbourhood promises, point by point: nothing is missing within the clear radius.
void expect_neighbourhood(const Neighbourhood& near, const Cloud& cloud,
                          const std::vector<Neighbour>& expected, float margin, float radius) {
  ASSERT_LE(near.count, Neighbourhood::kCapacity);
  if (expected.empty()) {
    ASSERT_EQ(near.count, 0U);
    ASSERT_EQ(near.clear_radius, radius);
    return;
  }
  std::set<std::uint32_t> listed;
  for (std::size_t i = 0; i < near.count; ++i) {
    listed.insert(near.index[i]);
    ASSERT_EQ(Point(near.x[i], near.y[i], near.z[i]), cloud[near.index[i]]);
  }
  ASSERT_EQ(listed.size(), near.count);
  ASSERT_TRUE(listed.contains(expected.front().index));
  for (const Neighbour& neighbour : expected) {
    if (std::sqrt(neighbour.squared_distance) < near.clear_radius * (1.0F - 1e-6F)) {
      ASSERT_TRUE(listed.contains(neighbour.index));
    }
  }
  const float reach = std::min(radius, std::sqrt(expected.front().squared_distance) + margin);
  if (near.count < Neighbourhood::kCapacity) {
    ASSERT_GE(near.clear_radius, reach * (1.0F - 1e-6F));
  } else {
    ASSERT_LE(near.clear_radius, std::max(reach, std::sqrt(expected[near.count - 1].squared_distance)));
    ASSERT_GE(near.clear_radius, std::min(reach, std::sqrt(expected[near.count - 1].squared_distance)));
  }
}

void expect_batches_equal_brute_force(const KdTree& tree, const Cloud& cloud, const Cloud& queries) {
  std::vector<Neighbour> nearest(queries.size());
  std::vector<Neighbourhood> near(queries.size());
  for (const float radius : {0.3F, kInfinity}) {
    tree.nearest(queries, radius, nearest);
    for (const float margin : {0.0F, 0.02F, 0.5F}) {
      tree.neighbourhoods(queries, std::vector<float>(queries.size(), radius), margin, near);
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const std::vector<Neighbour> expected = brute_force(cloud, queries[i], radius);
        ASSERT_EQ(nearest[i].index, expected.empty() ? Neighbour::kNone : expected.front().index);
        ASSERT_NO_FATAL_FAILURE(expect_neighbourhood(near[i], cloud, expected, margin, radius));
      }
    }
  }
}

/// within() gives the points that brute force does, whichever order.
void expect_all_within(const Cloud& found, const std::vector<Neighbour>& expected, const Cloud& cloud) {
  using Coordinates = std::array<float, 3>;
  std::multiset<Coordinates> given;
  std::multiset<Coordinates> wanted;
  for (const Point& p : found) {
    given.insert({p.x(), p.y(), p.z()});
  }
  for (const Neighbour& neighbour : expected) {
    const Point& p = cloud[neighbour.index];
    wanted.insert({p.x(), p.y(), p.z()});
  }
  ASSERT_EQ(given, wanted);
}

void expect_equals_brute_force(const KdTree& tree, const Cloud& cloud, const Cloud& queries) {
  std::vector<Neighbour> few;
  Cloud all;
  for (const Point& q : queries) {
    for (const float radius : {0.05F, 0.3F, 2.0F, kInfinity}) {
      const std::vector<Neighbour> expected = brute_force(cloud, q, radius);
      const std::optional<Neighbour> nearest = tree.nearest(q, radius);
      ASSERT_EQ(nearest.has_value(), !expected.empty());
      if (nearest) {
        ASSERT_EQ(nearest->index, expected.front().index);
        ASSERT_EQ(nearest->squared_distance, expected.front().squared_distance);
      }
      if (radius < 1.0F) {
        tree.within(q, radius, all);
        ASSERT_NO_FATAL_FAILURE(expect_all_within(all, expected, cloud));
      }
      for (const std::size_t k : {std::size_t{1}, std::size_t{5}, std::size_t{40}}) {
        tree.nearest_k(q, k, radius, few);
        ASSERT_EQ(few.size(), std::min(k, expected.size()));
        for (std::size_t i = 0; i < few.size(); ++i) {
          ASSERT_EQ(few[i].index, expected[i].index);
          ASSERT_EQ(few[i].squared_distance, expected[i].squared_distance);
        }
      }
    }
  }
  expect_batches_equal_brute_force(tree, cloud, queries);
}

void expect_equals_brute_force(const Cloud& cloud, const Cloud& queries) {
  for (const TreeUse use : {TreeUse::many_searches, TreeUse::one_batch}) {
    ASSERT_NO_FATAL_FAILURE(expect_equals_brute_force(KdTree(cloud, use), cloud, queries));
  }
}

TEST(KdTree, NearestDistanceEqualsBruteForce) {
  unsigned seed = 1;
  for (const std::size_t size : {1U, 2U, 31U, 32U, 33U, 256U, 257U, 2100U, 20000U}) {
    const Cloud cloud = random_cloud(size, Point(10.0F, 4.0F, 2.0F), ++seed);
    expect_equals_brute_force(cloud, random_cloud(60, Point(12.0F, 6.0F, 4.0F), ++seed));
  }
}

TEST(KdTree, EqualDistancesGiveTheLowestIndex) {
  for (const std::size_t size : {100U, 9000U}) {
    expect_equals_brute_force(grid_cloud(size, 5), grid_cloud(60, 6));
  }
  expect_equals_brute_force(Cloud(1000, Point(1.0F, 2.0F, 3.0F)),
                            random_cloud(10, Point(4.0F, 4.0F, 4.0F), 7));
}

TEST(KdTree, HandlesCloudsOnALineAndOnAPlane) {
  for (const Point& extent :
       {Point(50.0F, 0.0F, 0.0F), Point(0.0F, 9.0F, 9.0F), Point(1e-30F, 1e-38F, 0.0F)}) {
    expect_equals_brute_force(random_cloud(3000, extent, 8),
                              random_cloud(30, extent + Point(1.0F, 1.0F, 1.0F), 9));
  }
}

TEST(KdTree, FindsPointsFarFromTheOrigin) {
  Cloud cloud = random_cloud(5000, Point(40.0F, 20.0F, 5.0F), 10);
  Cloud queries = random_cloud(40, Point(40.0F, 20.0F, 5.0F), 11);
  for (Cloud* c : {&cloud, &queries}) {
    for (Point& p : *c) {
      p += Point(4.0e5F, -3.0e6F, 100.0F);
    }
  }
  expect_equals_brute_force(cloud, queries);
}

TEST(KdTree, SurvivesCoordinatesThatOverflowWhenSquared) {
  const float huge = std::numeric_limits<float>::max();
  Cloud cloud = random_cloud(500, Point(huge, huge, huge), 12);
  cloud.emplace_back(huge, -huge, huge);
  cloud.emplace_back(-huge, huge, -huge);
  cloud.emplace_back(0.5F, 0.0F, 0.0F);
  expect_equals_brute_force(cloud, {Point::Zero(), Point(huge, -huge, huge), Point(1.0F, 1.0F, 1.0F)});
}

TEST(KdTree, LeavesOutPointsThatAreNotFiniteAndKeepsIndices) {
  Cloud cloud = random_cloud(300, Point(2.0F, 2.0F, 2.0F), 13);
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    cloud[i][static_cast<Eigen::Index>(i % 3)] = i % 2 == 0 ? kNan : kInfinity;
  }
  EXPECT_EQ(KdTree(cloud).size(), 200U);
  EXPECT_EQ(KdTree(cloud, TreeUse::one_batch).size(), 200U);
  expect_equals_brute_force(cloud, random_cloud(50, Point(3.0F, 3.0F, 3.0F), 14));
}

TEST(KdTree, AnswersNothingWhereNothingCanBe) {
  const Cloud all_nan(40, Point(kNan, 0.0F, 0.0F));
  const Cloud one{Point::Zero()};
  std::vector<Neighbour> few{{1, 1.0F}};
  for (const Cloud& cloud : {Cloud{}, all_nan}) {
    for (const TreeUse use : {TreeUse::many_searches, TreeUse::one_batch}) {
      const KdTree tree(cloud, use);
      EXPECT_EQ(tree.size(), 0U);
      EXPECT_FALSE(tree.nearest(Point::Zero(), kInfinity));
      tree.nearest_k(Point::Zero(), 3, kInfinity, few);
      EXPECT_TRUE(few.empty());
    }
  }
  const KdTree tree(one);
  for (const Point& q :
       {Point(kNan, 0.0F, 0.0F), Point(0.0F, kInfinity, 0.0F), Point(0.0F, 0.0F, -kInfinity)}) {
    EXPECT_FALSE(tree.nearest(q, kInfinity));
  }
  std::vector<Neighbour> batch(3);
  tree.nearest(Cloud{Point(kNan, 0.0F, 0.0F), Point::Zero(), Point(0.0F, kInfinity, 0.0F)}, 1.0F, batch);
  EXPECT_EQ(batch[0].index, Neighbour::kNone);
  EXPECT_EQ(batch[1].index, 0U);
  EXPECT_EQ(batch[2].index, Neighbour::kNone);
  for (const float radius : {0.0F, -1.0F, kNan}) {
    EXPECT_FALSE(tree.nearest(Point::Zero(), radius));
  }
  EXPECT_FALSE(tree.nearest(Point(0.3F, 0.0F, 0.0F), 0.3F)) << "the radius is exclusive";
}

TEST(KdTree, EveryInstructionSetGivesTheSameBits) {
  if (!kdtree::avx2_available()) {
    GTEST_SKIP() << "this processor has no AVX2 to compare with";
  }
  const kdtree::Layout layout = kdtree::build(grid_cloud(30000, 15));
  const Cloud queries = random_cloud(3000, Point(14.0F, 10.0F, 5.0F), 16);
  const kdtree::Kernels& sse2 = kdtree::sse2_kernels();
  const kdtree::Kernels& avx2 = kdtree::avx2_kernels();
  const auto same = [](const kdtree::Hit& a, const kdtree::Hit& b) {
    return a.slot == b.slot && a.squared_distance == b.squared_distance;
  };

  std::vector<kdtree::Hit> a(queries.size());
  std::vector<kdtree::Hit> b(queries.size());
  sse2.nearest(layout, queries, 0.25F, a.data());
  avx2.nearest(layout, queries, 0.25F, b.data());
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), same));

  std::vector<Neighbourhood> a_near(queries.size());
  std::vector<Neighbourhood> b_near(queries.size());
  const std::vector<float> radii(queries.size(), 0.5F);
  sse2.neighbourhoods(layout, queries, radii.data(), 0.1F, a_near.data());
  avx2.neighbourhoods(layout, queries, radii.data(), 0.1F, b_near.data());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    ASSERT_EQ(a_near[i].count, b_near[i].count);
    ASSERT_EQ(a_near[i].clear_radius, b_near[i].clear_radius);
    ASSERT_TRUE(std::equal(a_near[i].index.begin(), a_near[i].index.begin() + a_near[i].count,
                           b_near[i].index.begin()));
  }

  std::array<kdtree::Hit, 12> a_few{};
  std::array<kdtree::Hit, 12> b_few{};
  for (const Point& q : queries) {
    const std::size_t count = sse2.nearest_k(layout, q, 0.25F, a_few);
    ASSERT_EQ(count, avx2.nearest_k(layout, q, 0.25F, b_few));
    ASSERT_TRUE(
        std::equal(a_few.begin(), a_few.begin() + static_cast<std::ptrdiff_t>(count), b_few.begin(), same));
  }
}

TEST(KdTree, LeavesAreFullAndHoldEveryPointOnce) {
  for (const std::size_t size : {1U, 40U, 5000U, 70000U}) {
    const Cloud cloud = random_cloud(size, Point(30.0F, 20.0F, 1.0F), 17);
    for (const kdtree::Layout& layout : {kdtree::build(cloud), kdtree::build_along_curve(cloud)}) {
      EXPECT_EQ(layout.leaves.size(), (size + kdtree::kLeafSize - 1) / kdtree::kLeafSize);
      std::vector<int> seen(size, 0);
      for (const std::uint32_t index : layout.index) {
        if (index != std::numeric_limits<std::uint32_t>::max()) {
          ++seen.at(index);
        }
      }
      EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(size));
    }
  }
}

}  // namespace
}  // namespace hulltrack
