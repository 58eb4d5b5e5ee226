#include "core/map/relief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "core/map/horizons.hpp"

namespace hulltrack {
namespace {

constexpr float kRim = 1.4F;
constexpr float kFloor = -6.0F;
constexpr float kSpacing = 0.1F;

void add_level(Cloud& cloud, float x0, float x1, float y0, float y1, float z) {
  for (float x = x0 + kSpacing / 2; x < x1; x += kSpacing) {
    for (float y = y0 + kSpacing / 2; y < y1; y += kSpacing) {
      cloud.emplace_back(x, y, z);
    }
  }
}

/// The four walls of a rectangle, from z0 to z1.
void add_walls(Cloud& cloud, float x0, float x1, float y0, float y1, float z0, float z1) {
  for (float z = z0; z <= z1 + 1e-3F; z += kSpacing) {
    cloud.emplace_back(x1, y1, z);  // a gap in a corner would be seen through
    for (float x = x0; x <= x1 + 1e-3F; x += kSpacing) {
      cloud.emplace_back(x, y0, z);
      cloud.emplace_back(x, y1, z);
    }
    for (float y = y0; y <= y1 + 1e-3F; y += kSpacing) {
      cloud.emplace_back(x0, y, z);
      cloud.emplace_back(x1, y, z);
    }
  }
}

/// A deck of 40 x 20 m at z = 0 with a bulwark of 1.2 m all around, an open hatch -8..8 x -5..5 with a
/// coaming of 1.4 m above a floor at -6, and a house of 8 m. `floor` false: the hold was too dark for the
/// survey.
Cloud ship(bool floor = true) {
  Cloud cloud;
  add_level(cloud, -20.0F, -8.0F, -10.0F, 10.0F, 0.0F);
  add_level(cloud, 8.0F, 20.0F, -10.0F, 10.0F, 0.0F);
  add_level(cloud, -8.0F, 8.0F, -10.0F, -5.0F, 0.0F);
  add_level(cloud, -8.0F, 8.0F, 5.0F, 10.0F, 0.0F);
  add_walls(cloud, -20.0F, 20.0F, -10.0F, 10.0F, 0.0F, 1.2F);
  add_walls(cloud, -8.0F, 8.0F, -5.0F, 5.0F, floor ? kFloor : 0.0F, kRim);
  if (floor) {
    add_level(cloud, -8.0F, 8.0F, -5.0F, 5.0F, kFloor);
  }
  add_walls(cloud, -19.0F, -15.0F, -8.0F, 8.0F, 0.0F, 8.0F);
  add_level(cloud, -19.0F, -15.0F, -8.0F, 8.0F, 8.0F);
  return cloud;
}

/// The horizon of p's cell by its definition, cell after cell; nothing if one direction has no point.
std::optional<float> horizon_by_definition(const std::map<std::pair<int, int>, float>& tops, int column,
                                           int row) {
  float least = std::numeric_limits<float>::infinity();
  for (const auto& [dc, dr] : std::vector<std::pair<int, int>>{
           {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
    const float stride = dc != 0 && dr != 0 ? std::sqrt(2.0F) * LevelCells::kCell : LevelCells::kCell;
    std::optional<float> highest;
    for (int i = 1; i <= static_cast<int>(kHorizonReach / stride); ++i) {
      if (const auto top = tops.find({column + i * dc, row + i * dr}); top != tops.end()) {
        highest = std::max(highest.value_or(top->second), top->second);
      }
    }
    if (!highest) {
      return std::nullopt;
    }
    least = std::min(least, *highest);
  }
  return least;
}

TEST(Relief, AHorizonIsTheLeastOfTheHighestInEightDirections) {
  std::mt19937 random(5);
  std::size_t holds = 0;
  for (const int points : {200, 1000, 5000}) {
    std::uniform_real_distribution<float> along(0.0F, 45.0F);
    std::uniform_real_distribution<float> up(0.0F, 9.0F);
    Cloud cloud = {Point::Zero()};
    std::map<std::pair<int, int>, float> tops = {{{0, 0}, 0.0F}};
    for (int i = 0; i < points; ++i) {
      const Point p(along(random), along(random), up(random));
      cloud.push_back(p);
      float& top = tops.try_emplace({static_cast<int>(p.x() / LevelCells::kCell),
                                     static_cast<int>(p.y() / LevelCells::kCell)},
                                    p.z())
                       .first->second;
      top = std::max(top, p.z());
    }
    const Relief relief(cloud);
    for (int column = 0; column < 180; ++column) {
      for (int row = 0; row < 180; ++row) {
        const auto horizon = horizon_by_definition(tops, column, row);
        const float z = horizon.value_or(0.0F) - Relief::kDepth;
        const Point p((static_cast<float>(column) + 0.5F) * LevelCells::kCell,
                      (static_cast<float>(row) + 0.5F) * LevelCells::kCell, z);
        ASSERT_EQ(relief.in_hold(p - Point(0.0F, 0.0F, 0.01F)), horizon.has_value()) << column << ", " << row;
        ASSERT_FALSE(relief.in_hold(p + Point(0.0F, 0.0F, 0.01F))) << column << ", " << row;
        holds += horizon ? 1 : 0;
      }
    }
  }
  EXPECT_GT(holds, 10000U);
}

TEST(Relief, AHoldIsAPitAndItsRimIsTheCoaming) {
  const Relief relief(ship());
  for (float x = -7.0F; x <= 7.0F; x += 0.7F) {
    for (float y = -4.0F; y <= 4.0F; y += 0.7F) {
      EXPECT_TRUE(relief.in_hold({x, y, kFloor})) << x << ", " << y;
      EXPECT_TRUE(relief.in_hold({x, y, kRim - 2.1F})) << "cargo that is 2.1 m below the rim";
      EXPECT_FALSE(relief.in_hold({x, y, kRim - 1.9F})) << "cargo that is 1.9 m below it";
      EXPECT_NEAR(relief.rim_height_around({x, y, kFloor}), kRim, 1e-3F) << x << ", " << y;
    }
  }
}

TEST(Relief, ADeckBetweenBulwarkCoamingAndHouseIsNoPit) {
  const Relief relief(ship());
  for (float x = -14.0F; x <= 19.0F; x += 0.7F) {
    for (const float y : {-9.0F, -7.0F, -5.7F, 5.7F, 7.0F, 9.0F}) {
      EXPECT_FALSE(relief.in_hold({x, y, 0.0F})) << x << ", " << y;
      EXPECT_TRUE(std::isnan(relief.rim_height_around({x, y, 0.0F}))) << x << ", " << y;
    }
  }
  for (const float y : {-7.0F, 0.0F, 7.0F}) {
    EXPECT_FALSE(relief.in_hold({-13.0F, y, 0.0F})) << "between house and hatch";
  }
}

TEST(Relief, CoversStandAboveTheRimWithinTheirReachOfTheHatch) {
  const Relief relief(ship());
  EXPECT_TRUE(relief.in_covers_place({0.0F, 0.0F, 1.8F})) << "over the hatch";
  EXPECT_TRUE(relief.in_covers_place({9.5F, 0.0F, 3.0F})) << "beside it";
  EXPECT_FALSE(relief.in_covers_place({9.5F, 0.0F, 1.3F})) << "lower than the rim";
  EXPECT_FALSE(relief.in_covers_place({0.0F, 4.9F, kRim})) << "the rim itself";
  EXPECT_FALSE(relief.in_covers_place({12.0F, 0.0F, 3.0F})) << "farther than covers stand";
  EXPECT_FALSE(relief.in_covers_place({-15.5F, 0.0F, 8.0F})) << "the house";
}

TEST(Relief, WhatStandsInTheCoversPlaceBelongsToItDownToTheDeck) {
  Cloud cloud = ship();
  add_walls(cloud, 9.0F, 9.5F, -4.0F, 4.0F, 0.0F, 3.0F);  // covers folded forward of the hatch
  const Relief relief(cloud);
  EXPECT_TRUE(relief.under_covers_place({9.0F, 0.0F, 0.3F}));
  EXPECT_TRUE(relief.under_covers_place({9.5F, 3.0F, 1.0F}));
  EXPECT_FALSE(relief.under_covers_place({10.5F, 0.0F, 0.3F})) << "beside them";
  EXPECT_FALSE(relief.under_covers_place({8.0F, 0.0F, 0.3F})) << "the coaming";
  EXPECT_FALSE(Relief(ship()).under_covers_place({9.0F, 0.0F, 0.3F})) << "without them";
}

TEST(Relief, AGapInACoamingLowersNoRim) {
  Cloud cloud = ship();
  std::erase_if(cloud, [](const Point& p) {  // 1 m of a side and a corner as good as cut away
    const bool side = p.y() > 4.95F && p.y() < 5.05F && std::abs(p.x() - 1.0F) < 0.5F;
    const bool corner = p.x() > 7.0F && p.x() < 8.05F && p.y() < -4.0F && p.y() > -5.05F;
    return (side || corner) && p.z() > 0.75F && p.z() < 1.45F;
  });
  const Relief relief(cloud);
  for (float x = -7.0F; x <= 7.0F; x += 0.7F) {
    for (float y = -4.0F; y <= 4.0F; y += 0.7F) {
      EXPECT_NEAR(relief.rim_height_around({x, y, kFloor}), kRim, 1e-3F) << x << ", " << y;
    }
  }
  EXPECT_FALSE(relief.in_covers_place({-3.0F, 5.0F, kRim})) << "the coaming's top";
}

TEST(Relief, AGapUnderALedgeIsNoHoldThatCoversLieOver) {
  Cloud cloud = ship();
  // Along one coaming, unseen from above: a gap of 0.4 m below a ledge that is lower than the coaming.
  std::erase_if(cloud,
                [](const Point& p) { return p.y() > 5.05F && p.y() < 5.5F && std::abs(p.x()) < 8.0F; });
  add_walls(cloud, -8.0F, 8.0F, 5.5F, 5.7F, 0.0F, kRim - 0.3F);
  EXPECT_FALSE(Relief(cloud).in_covers_place({0.0F, 5.0F, kRim})) << "the coaming's top";
}

TEST(Relief, EveryHoldHasItsNumber) {
  Cloud cloud = ship();
  const std::size_t one = cloud.size();
  for (std::size_t i = 0; i < one; ++i) {
    cloud.push_back(cloud[i] + Point(40.0F, 0.0F, 0.0F));
  }
  const Relief relief(cloud);
  const std::uint32_t aft = relief.hold_near({0.0F, 0.0F, 0.0F}, 1.0F);
  const std::uint32_t forward = relief.hold_near({40.0F, 0.0F, 0.0F}, 1.0F);
  EXPECT_NE(aft, Relief::kNoHold);
  EXPECT_NE(forward, Relief::kNoHold);
  EXPECT_NE(aft, forward);
  for (const Point& at : {Point(8.2F, 3.0F, kRim), Point(-8.2F, 0.0F, 0.5F), Point(2.0F, -5.2F, 0.0F)}) {
    EXPECT_EQ(relief.hold_near(at, 1.0F), aft) << at.transpose();
  }
  EXPECT_EQ(relief.hold_near({12.0F, 0.0F, 0.0F}, 1.0F), Relief::kNoHold);
}

TEST(Relief, AHoldThatNoSurveySawIsNone) {
  const Relief relief(ship(false));
  EXPECT_TRUE(std::isnan(relief.rim_height_around({0.0F, 0.0F, 0.0F})));
}

TEST(Relief, TheShadowBesideAPitIsPit) {
  Cloud cloud = ship();
  std::erase_if(cloud, [](const Point& p) {  // the floor below one side is hidden by the coaming
    return p.z() < -1.0F && p.y() > 3.0F;
  });
  const Relief relief(cloud);
  for (const float x : {-5.0F, 0.0F, 5.0F}) {
    EXPECT_NEAR(relief.rim_height_around({x, 4.0F, kFloor}), kRim, 1e-3F) << x;
  }
}

TEST(Relief, PointOverTheHoldIsTheNearestCellInsideOfItsRim) {
  const Relief relief(ship());
  const auto over = relief.over_hold_near({0.0F, 5.8F, kRim}, 2.0F);
  ASSERT_TRUE(over);
  EXPECT_NEAR(over->x(), 0.0F, LevelCells::kCell);
  EXPECT_LT(over->y(), 5.0F - LevelCells::kCell / 2) << "inside";
  EXPECT_GT(over->y(), 5.0F - 3.0F * LevelCells::kCell) << "near";
  EXPECT_EQ(over->z(), kRim);
  EXPECT_FALSE(relief.over_hold_near({0.0F, 5.8F, kRim}, 0.5F)) << "out of reach";
  EXPECT_FALSE(relief.over_hold_near({19.0F, 9.0F, kRim}, 2.0F)) << "no hatch there";
}

/// An open box: four walls of 3 m about a floor, its corner at `corner`.
Cloud open_box(const Point& corner, float side) {
  Cloud cloud;
  add_level(cloud, corner.x(), corner.x() + side, corner.y(), corner.y() + side, corner.z());
  add_walls(cloud, corner.x(), corner.x() + side, corner.y(), corner.y() + side, corner.z(),
            corner.z() + 3.0F);
  return cloud;
}

TEST(Relief, ASmallHoldHasItsOwnRimWhereverTheMapEnds) {
  // Smaller than the window that rims are smoothed in, and as near to the map's edges as can be.
  for (float side = 0.75F; side < 4.0F; side += 0.25F) {
    for (const float before : {0.0F, 0.25F, 0.5F, 1.0F, 2.0F, 3.5F}) {
      Cloud cloud = open_box({before, 0.5F * before, 0.0F}, side);
      cloud.emplace_back(0.0F, 0.0F, 0.0F);
      const Relief relief(cloud);
      const float middle = before + 0.5F * side;
      if (const auto over = relief.over_hold_near({middle, 0.5F * before + 0.5F * side, 3.0F}, side)) {
        EXPECT_NEAR(relief.rim_height_around(*over), 3.0F, 0.15F)
            << side << " m, " << before << " m from the edge";
      } else {
        EXPECT_LT(side, 1.5F) << before << " m from the edge";
      }
    }
  }
}

TEST(Relief, TheHoldAtTheMapsEdgeHasNoOthersRim) {
  Cloud cloud = open_box({0.0F, 0.0F, 0.0F}, 1.5F);
  for (const Point& p :
       open_box({8.0F, 8.0F, 20.0F}, 6.0F)) {  // far above, first in no order and last in none
    cloud.push_back(p);
  }
  const Relief relief(cloud);
  EXPECT_NEAR(relief.rim_height_around({0.75F, 0.75F, 0.0F}), 3.0F, 0.15F);
  EXPECT_NEAR(relief.rim_height_around({11.0F, 11.0F, 20.0F}), 23.0F, 0.15F);
}

TEST(Relief, AHoldThatWasSeenFromOneSideAloneIsWhollyPit) {
  // 13 x 13 m; of its floor a strip of a metre was seen: most of the hold holds no point at all.
  Cloud cloud;
  add_walls(cloud, 0.0F, 13.0F, 0.0F, 13.0F, 0.0F, kRim);
  add_level(cloud, 0.25F, 12.75F, 0.25F, 1.25F, kFloor);
  const Relief relief(cloud);
  for (float x = 1.0F; x < 12.5F; x += 0.7F) {
    for (float y = 1.0F; y < 12.5F; y += 0.7F) {
      EXPECT_NEAR(relief.rim_height_around({x, y, kFloor}), kRim, 1e-3F) << x << ", " << y;
      EXPECT_TRUE(relief.in_covers_place({x, y, kRim + 0.2F})) << x << ", " << y;
    }
  }
}

TEST(Relief, ShipsFarApartAreSeenAsEachAlone) {
  const Cloud one = ship();
  const Point apart(4096.0F, -2048.0F, 0.0F);
  Cloud both = one;
  for (const Point& p : one) {
    both.push_back(p + apart);
  }
  const Relief alone(one);
  const Relief relief(both);
  for (float x = -20.0F; x <= 20.0F; x += 0.31F) {
    for (float y = -10.0F; y <= 10.0F; y += 0.31F) {
      for (const float z : {kFloor, 0.0F, 2.0F}) {
        const Point p(x, y, z);
        for (const Point& q : {p, Point(p + apart)}) {
          EXPECT_EQ(relief.in_hold(q), alone.in_hold(p)) << q.transpose();
          EXPECT_EQ(relief.under_covers_place(q), alone.under_covers_place(p)) << q.transpose();
          EXPECT_EQ(std::isnan(relief.rim_height_around(q)), std::isnan(alone.rim_height_around(p)))
              << q.transpose();
        }
      }
    }
  }
}

TEST(Relief, MemoryGrowsWithThePointsNotWithHowFarTheyLieApart) {
  Cloud strewn;
  Cloud diagonal;
  for (int i = 0; i < 3000; ++i) {
    const auto f = static_cast<float>(i);
    strewn.emplace_back(std::fmod(f * 618.034F, 20'000.0F) - 10'000.0F, 6.0F * f - 9'000.0F, 0.0F);
    diagonal.emplace_back(6.0F * f - 9'000.0F, 6.0F * f - 9'000.0F, 0.0F);
  }
  for (const Cloud& cloud : {strewn, diagonal}) {
    EXPECT_LT(Relief(cloud).memory(), cloud.size() * 40'000);
  }
}

TEST(Relief, OutsideOfTheMapIsNothing) {
  const Relief relief(ship());
  for (const Point& p :
       {Point(30, 0, 0), Point(-30, 0, 0), Point(0, 30, 0), Point(0, -30, 0), Point(1e30F, -1e30F, 0)}) {
    EXPECT_FALSE(relief.in_hold(p));
    EXPECT_FALSE(relief.in_covers_place(p));
    EXPECT_TRUE(std::isnan(relief.rim_height_around(p)));
  }
}

}  // namespace
}  // namespace hulltrack
