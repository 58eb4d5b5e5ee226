#include "core/quay/quay_map.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <random>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

using testing::quay_cloud;

TEST(QuayMap, HasPlanesOfEachSurfaceAndAllOfThemInTiles) {
  const QuayMap map(quay_cloud());
  EXPECT_GT(map.count(SurfaceClass::transverse), 100U);
  EXPECT_GT(map.count(SurfaceClass::longitudinal), 100U);
  EXPECT_GT(map.count(SurfaceClass::horizontal), 1000U);
  std::size_t in_tiles = 0;
  for (std::size_t surface = 0; surface < QuayMap::kClasses; ++surface) {
    for (const QuayMap::Tile& tile : map.tiles(surface)) {
      in_tiles += tile.count;
      for (std::uint32_t i = tile.first; i < tile.first + tile.count; ++i) {
        EXPECT_EQ(static_cast<std::size_t>(map.planes().at(i).surface), surface);
        EXPECT_LE((map.planes().at(i).centre_W - tile.middle_W).norm(), tile.radius + 1e-3F);
      }
    }
  }
  EXPECT_EQ(in_tiles, map.planes().size());
}

TEST(QuayMap, NamesTheClassOfEveryReturnThatAPlaneHoldsAndOfNoneFarAway) {
  const QuayMap map(quay_cloud());
  std::mt19937 random(5);
  std::uniform_real_distribution<float> off(-QuayMap::kGate, QuayMap::kGate);
  std::uniform_real_distribution<float> beside(-0.3F, 0.3F);
  for (const QuayMap::Plane& plane : map.planes()) {
    const Point p = plane.centre_W + off(random) * plane.normal_W + Point(beside(random), 0.0F, 0.0F);
    if (plane.holds(p, QuayMap::kGate)) {
      EXPECT_NE(map.classes_near(p) & (1U << static_cast<unsigned>(plane.surface)), 0) << p.transpose();
    }
  }
  EXPECT_EQ(map.classes_near({0.0F, -10.0F, 1.5F}), 0);
  EXPECT_EQ(map.classes_near({1e9F, 0.0F, 0.0F}), 0);
  EXPECT_EQ(map.classes_near(Point::Constant(std::numeric_limits<float>::quiet_NaN())), 0);
}

TEST(QuayMap, AWallSeenFromBothSidesIsNoWitness) {
  Cloud cloud = quay_cloud({1});
  const std::size_t one_side = cloud.size();
  for (std::size_t i = 0; i < one_side; ++i) {
    cloud.push_back(cloud[i] + Point(0.3F, 0.0F, 0.0F));
  }
  EXPECT_EQ(QuayMap(cloud).planes().size(), 0U);
  EXPECT_GT(QuayMap(quay_cloud({1})).planes().size(), 100U);
}

TEST(QuayMap, OfCloudsWithoutFlatPartsHasNoPlanes) {
  EXPECT_EQ(QuayMap(Cloud{}).planes().size(), 0U);
  EXPECT_EQ(QuayMap(Cloud{Point(1.0F, 2.0F, 3.0F)}).planes().size(), 0U);
  EXPECT_EQ(QuayMap(Cloud(1000, Point(1.0F, 2.0F, 3.0F))).planes().size(), 0U);
  EXPECT_EQ(QuayMap(Cloud{Point(-1e4F, 0.0F, 0.0F), Point(1e4F, 0.0F, 0.0F)}).planes().size(), 0U);
}

}  // namespace
}  // namespace hulltrack
