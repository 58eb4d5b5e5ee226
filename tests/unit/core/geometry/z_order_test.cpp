#include "core/geometry/z_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <set>

namespace hulltrack {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Which of two lattice points comes first: the axis with the highest differing bit decides; z before y before
// x.
bool comes_first(const Point& a, const Point& b) {
  int axis = 2;
  int highest = 0;
  for (const int candidate : {2, 1, 0}) {
    const int difference = static_cast<int>(a[candidate]) ^ static_cast<int>(b[candidate]);
    if (highest < difference && highest < (highest ^ difference)) {
      axis = candidate;
      highest = difference;
    }
  }
  return a[axis] < b[axis];
}

TEST(ZOrder, TheHighestDifferingBitDecides) {
  std::mt19937 rng(1);
  std::set<std::array<int, 3>> lattice{{0, 0, 0}, {1024, 0, 0}};  // the box is 1024 wide: a cell is 1
  std::uniform_int_distribution<int> u(0, 1023);
  while (lattice.size() < 3000) {
    lattice.insert({u(rng), u(rng), u(rng)});
  }
  lattice.erase({1023, 0, 0});  // would share the last cell with the box's corner
  Cloud cloud;
  for (const auto& [x, y, z] : lattice) {
    cloud.push_back(Point(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)));
  }
  std::shuffle(cloud.begin(), cloud.end(), rng);
  const auto order = z_order(cloud);
  ASSERT_EQ(order.size(), cloud.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Point last = cloud[order[i - 1]].cwiseMin(1023.0F);
    EXPECT_TRUE(comes_first(last, cloud[order[i]].cwiseMin(1023.0F))) << i;
  }
}

TEST(ZOrder, HoldsEveryFinitePointOnce) {
  const Cloud cloud{{1, 2, 3}, {kNaN, 0, 0}, {1, 2, 3}, {0, kInfinity, 0}, {-4, 5, 6}, {0, 0, -kInfinity}};
  auto order = z_order(cloud);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, (std::vector<std::uint32_t>{0, 2, 4}));
}

TEST(ZOrder, AnyBoxWillDo) {
  EXPECT_TRUE(z_order({}).empty());
  EXPECT_EQ(z_order(Cloud(5, Point(7, 7, 7))).size(), 5U);
  const float huge = std::numeric_limits<float>::max();
  EXPECT_EQ(z_order(Cloud{{-huge, 0, 0}, {huge, 0, 0}, {1, 2, 3}}).size(), 3U);
}

}  // namespace
}  // namespace hulltrack
