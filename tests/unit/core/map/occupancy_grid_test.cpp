#include "core/map/occupancy_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <tuple>
#include <vector>

namespace hulltrack {
namespace {

using Index = OccupancyGrid::Index;
using Values = std::array<std::uint16_t, OccupancyGrid::kHeights>;

Cloud random_cloud(int count, const Point& half, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Cloud cloud;
  for (int i = 0; i < count; ++i) {
    cloud.push_back(half.cwiseProduct(Point(unit(random), unit(random), unit(random))));
  }
  return cloud;
}

/// The value of a cell, by looking for it and its six neighbours.
class Counted {
 public:
  Counted(const OccupancyGrid& grid, const Cloud& cloud) {
    for (const Point& p : cloud) {
      const Index i = grid.cell_of(p);
      occupied_.insert({i.x, i.y, i.z});
    }
  }
  [[nodiscard]] int value(int x, int y, int z) const {
    if (occupied_.contains({x, y, z})) {
      return 2;
    }
    const bool beside = occupied_.contains({x - 1, y, z}) || occupied_.contains({x + 1, y, z}) ||
                        occupied_.contains({x, y - 1, z}) || occupied_.contains({x, y + 1, z}) ||
                        occupied_.contains({x, y, z - 1}) || occupied_.contains({x, y, z + 1});
    return beside ? 1 : 0;
  }

 private:
  std::set<std::tuple<int, int, int>> occupied_;
};

TEST(OccupancyGrid, CorrelationIsWhatCountingCellByCellGives) {
  std::mt19937 random(1);
  const Cloud map = random_cloud(400, {6.0F, 3.0F, 2.0F}, random);
  const OccupancyGrid grid(map);
  const Counted counted(grid, map);
  std::vector<Index> cells;
  // Inside, and far outside in every direction.
  for (const Point& half : {Point(6.0F, 3.0F, 2.0F), Point(12.0F, 9.0F, 20.0F), Point(300.0F, 3.0F, 50.0F)}) {
    for (const Point& p : random_cloud(100, half, random)) {
      cells.push_back(grid.cell_of(p));
    }
  }
  int most = 0;
  for (int x = -14; x <= 14; x += 2) {
    for (int y = -9; y <= 9; y += 3) {
      Values values{};
      grid.correlate(cells, x, y, values);
      for (int k = -OccupancyGrid::kUp; k <= OccupancyGrid::kUp; ++k) {
        int sum = 0;
        for (const Index& c : cells) {
          sum += counted.value(c.x + x, c.y + y, c.z + k);
        }
        ASSERT_EQ(values[static_cast<std::size_t>(OccupancyGrid::kUp + k)], sum)
            << x << ", " << y << ", " << k;
        most = std::max(most, sum);
      }
    }
  }
  EXPECT_GT(most, 50) << "there was something to count";
}

TEST(OccupancyGrid, CorrelationIsAddedToWhatIsThere) {
  std::mt19937 random(2);
  const Cloud map = random_cloud(50, {2.0F, 2.0F, 2.0F}, random);
  const OccupancyGrid grid(map);
  const std::vector<Index> cells{grid.cell_of(map.front())};
  Values once{};
  grid.correlate(cells, 0, 0, once);
  Values twice = once;
  grid.correlate(cells, 0, 0, twice);
  EXPECT_EQ(once[OccupancyGrid::kUp], 2);
  for (std::size_t k = 0; k < once.size(); ++k) {
    EXPECT_EQ(twice[k], 2 * once[k]);
  }
}

TEST(OccupancyGrid, AShiftByWholeCellsIsOneOfTheirNumbers) {
  std::mt19937 random(3);
  const OccupancyGrid grid(random_cloud(50, {5.0F, 5.0F, 5.0F}, random));
  // Cell middles, so that rounding does not decide.
  const Index origin = grid.cell_of(Point::Zero());
  std::uniform_int_distribution<int> number(-40, 40);
  Point middle = Point::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](float v) {
      const Index i = grid.cell_of(v * Point::Unit(axis));
      return axis == 0 ? i.x - origin.x : axis == 1 ? i.y - origin.y : i.z - origin.z;
    };
    float v = 0.0F;
    while (at(v) == 0) {
      v += 0.001F;
    }
    middle[axis] = v - OccupancyGrid::kCell / 2.0F;
  }
  for (int i = 0; i < 100; ++i) {
    const Index d{number(random), number(random), number(random)};
    const Index moved =
        grid.cell_of(middle + OccupancyGrid::kCell * Point(static_cast<float>(d.x), static_cast<float>(d.y),
                                                           static_cast<float>(d.z)));
    EXPECT_EQ(moved.x - origin.x, d.x);
    EXPECT_EQ(moved.y - origin.y, d.y);
    EXPECT_EQ(moved.z - origin.z, d.z);
  }
}

TEST(OccupancyGrid, TheHighestShiftOfTheLastColumnIsWithinTheGrid) {
  // A sanitizer's business: what is read beyond the grid's end is asked for by nobody.
  const OccupancyGrid grid(Cloud{Point::Zero()});
  const Index middle = grid.cell_of(Point::Zero());  // of an odd number of cells on every axis
  const Index top{2 * middle.x, 2 * middle.y, 2 * middle.z + OccupancyGrid::kUp};
  Values values{};
  grid.correlate(std::vector<Index>{top}, 0, 0, values);
  EXPECT_EQ(values, Values{});
}

TEST(OccupancyGrid, PointsHoweverFarOutsideCountNothing) {
  const OccupancyGrid grid(Cloud{Point::Zero()});
  std::vector<Index> cells;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float far : {-1e30F, -1e4F, 1e4F, 1e30F}) {
      cells.push_back(grid.cell_of(far * Point::Unit(axis)));
    }
  }
  for (int x = -40; x <= 40; x += 20) {
    Values values{};
    grid.correlate(cells, x, 0, values);
    EXPECT_EQ(values, Values{});
  }
}

TEST(OccupancyGrid, AMapOfAnyLengthAnywhereIsCountedToItsLastCell) {
  // Lengths of whole cells in whole centimetres: the ratio rounds to either side of the whole number.
  std::mt19937 random(3);
  std::uniform_int_distribution<int> cells(1, 64);
  std::uniform_int_distribution<int> centimetre(-900'000, 900'000);
  for (int i = 0; i < 2000; ++i) {
    const int axis = i % 3;
    Point low(0.0F, 0.0F, 0.0F);
    low[axis] = static_cast<float>(0.01 * centimetre(random));
    Point high = low;
    high[axis] = static_cast<float>(static_cast<double>(low[axis]) + 0.5 * cells(random));
    const Cloud map{low, high};
    const OccupancyGrid grid(map);
    const Counted counted(grid, map);
    for (const Point& end : map) {
      const Index at = grid.cell_of(end);
      for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
          Values values{};
          grid.correlate(std::vector<Index>{at}, x, y, values);
          for (int k = -2; k <= 2; ++k) {
            ASSERT_EQ(values[static_cast<std::size_t>(OccupancyGrid::kUp + k)],
                      counted.value(at.x + x, at.y + y, at.z + k))
                << low.transpose() << " to " << high.transpose() << " at " << x << ", " << y << ", " << k;
          }
        }
      }
    }
  }
}

TEST(OccupancyGrid, MastsAndHoldsOfAnyHeightAreCounted) {
  std::mt19937 random(4);
  const Cloud map = random_cloud(3000, {1.0F, 1.0F, 400.0F}, random);
  const OccupancyGrid grid(map);
  const Counted counted(grid, map);
  for (const Point& p : random_cloud(500, {1.5F, 1.5F, 420.0F}, random)) {
    const Index at = grid.cell_of(p);
    Values values{};
    grid.correlate(std::vector<Index>{at}, 0, 0, values);
    for (int k = -OccupancyGrid::kUp; k <= OccupancyGrid::kUp; ++k) {
      ASSERT_EQ(values[static_cast<std::size_t>(OccupancyGrid::kUp + k)], counted.value(at.x, at.y, at.z + k))
          << p.transpose() << " at " << k;
    }
  }
}

TEST(OccupancyGrid, MemoryGrowsWithThePointsNotWithHowFarTheyLieApart) {
  std::mt19937 random(5);
  const Cloud map = random_cloud(3000, {10'000.0F, 10'000.0F, 10'000.0F}, random);
  EXPECT_LT(OccupancyGrid(map).memory(), map.size() * 30'000);
}

}  // namespace
}  // namespace hulltrack
