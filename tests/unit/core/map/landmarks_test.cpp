// A hatch written by hand: a deck with a hold in it, a coaming of 0.3 m breadth around, a locker beside it,
// covers folded on one end.
#include "core/map/landmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/geometry/box.hpp"
#include "core/map/hull_map.hpp"

namespace hulltrack {
namespace {

constexpr float kSpacing = 0.05F;
constexpr float kHalfLength = 8.0F;  // of the opening, x
constexpr float kHalfWidth = 5.0F;
constexpr float kBreadth = 0.3F;  // of the coaming
constexpr float kTop = 1.4F;
constexpr float kFloor = -7.0F;
constexpr float kCoverAt = 1.0F;  // forward of the opening

/// How far outside of the opening a level point lies; negative inside.
float outside(float x, float y) { return std::max(std::abs(x) - kHalfLength, std::abs(y) - kHalfWidth); }

Cloud hatch() {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0F, 0.005F);
  Cloud cloud;
  const auto add = [&](float x, float y, float z) {
    cloud.emplace_back(x + noise(random), y + noise(random), z + noise(random));
  };
  std::uniform_real_distribution<float> in_voxel(-0.5F * kSpacing, 0.5F * kSpacing);  // as a survey's points
  for (float column = -14.0F; column < 14.0F; column += kSpacing) {
    for (float row = -9.0F; row < 9.0F; row += kSpacing) {
      const float x = column + in_voxel(random);
      const float y = row + in_voxel(random);
      const float out = outside(x, y);
      add(x, y, out < 0.0F ? kFloor : out < kBreadth ? kTop : 0.0F);
    }
  }
  for (float z = kFloor; z < kTop; z += kSpacing) {
    for (float y = -kHalfWidth; y < kHalfWidth; y += kSpacing) {
      for (const float x : {-kHalfLength, kHalfLength}) {
        add(x, y, z);
        if (z > 0.0F) {
          add(x + std::copysign(kBreadth, x), y, z);
        }
      }
    }
    for (float x = -kHalfLength; x < kHalfLength; x += kSpacing) {
      for (const float y : {-kHalfWidth, kHalfWidth}) {
        add(x, y, z);
        if (z > 0.0F) {
          add(x, y + std::copysign(kBreadth, y), z);
        }
      }
    }
  }
  for (float y = -kHalfWidth; y < kHalfWidth;
       y += kSpacing) {  // a folded cover, on edge on the deck, forward
    for (float z = 0.0F; z < kTop + 2.0F; z += kSpacing) {
      add(kHalfLength + kCoverAt, y, z);
    }
  }
  return cloud;
}

class Hatch : public testing::Test {
 protected:
  static const HullMap& map() {
    static const HullMap one(hatch());
    return one;
  }
  static const Relief& relief() {
    static const Relief one(map().cloud_H());
    return one;
  }
};

TEST_F(Hatch, TheHoldIsFoundAndTheDeckIsNoHold) {
  EXPECT_TRUE(relief().in_hold({0.0F, 0.0F, kFloor}));
  EXPECT_TRUE(relief().in_hold({4.0F, -3.0F, -2.0F})) << "cargo's place";
  EXPECT_FALSE(relief().in_hold({0.0F, 0.0F, 0.5F})) << "less than 2 m below the rim";
  EXPECT_FALSE(relief().in_hold({0.0F, 7.0F, 0.0F}));
  EXPECT_FALSE(relief().in_hold({12.0F, 0.0F, 0.0F}));
}

TEST_F(Hatch, AboveTheRimIsTheCoversPlace) {
  EXPECT_TRUE(relief().in_covers_place({kHalfLength + 1.0F, 0.0F, kTop + 1.0F}));
  EXPECT_FALSE(relief().in_covers_place({kHalfLength + 0.15F, 0.0F, kTop}));
  EXPECT_FALSE(relief().in_covers_place({0.0F, 7.0F, 0.0F}));
  EXPECT_FALSE(relief().in_covers_place({0.0F, kHalfWidth + 3.5F, kTop + 1.0F})) << "too far aside";
}

TEST_F(Hatch, SurfacesOfCargoAndCoversAreMovableAndOfNoLandmark) {
  int movable = 0;
  for (std::size_t i = 0; i < map().subset_H().size(); ++i) {
    const Point& p = map().subset_H()[i];
    const Surfel& surfel = map().surfels()[i];
    const bool hold = outside(p.x(), p.y()) < 0.1F && p.z() < kTop - Relief::kDepth - 0.1F;
    const float from_cover = std::abs(p.x() - kHalfLength - kCoverAt);
    const bool beside_cover =
        from_cover < 2.0F * LevelCells::kCell + 0.05F && std::abs(p.y()) < kHalfWidth + 0.6F;
    const bool cover = p.z() > kTop + 0.3F || (from_cover < 0.1F && std::abs(p.y()) < kHalfWidth);
    if (hold || cover) {
      EXPECT_TRUE(surfel.movable) << p.transpose();
      EXPECT_EQ(surfel.landmark, Surfel::kNoLandmark) << p.transpose();
      ++movable;
    } else if (!beside_cover && p.z() > kTop - Relief::kDepth + 0.1F && p.z() < kTop + 0.1F) {
      EXPECT_FALSE(surfel.movable) << p.transpose();
    }
  }
  EXPECT_GT(movable, 500);
}

TEST_F(Hatch, RimsLieOnTheCoamingsMiddleAndKnowItsEdges) {
  std::array<int, 4> sides{};
  for (const RimPoint& rim : map().rims()) {
    if (rim.landmark == Surfel::kNoLandmark) {
      continue;
    }
    EXPECT_NEAR(outside(rim.p_H.x(), rim.p_H.y()), 0.5F * kBreadth, 0.05F) << rim.p_H.transpose();
    EXPECT_NEAR(rim.p_H.z(), kTop, 0.02F);
    const bool along_x = std::abs(rim.across_H.y()) > 0.9F;
    const float to_hold = along_x ? rim.across_H.y() * rim.p_H.y() : rim.across_H.x() * rim.p_H.x();
    EXPECT_LT(to_hold, 0.0F) << "across is towards the hold";
    const bool measured = rim.begin < rim.end;
    ASSERT_TRUE(measured) << rim.p_H.transpose();
    const float middle = outside(rim.p_H.x(), rim.p_H.y());
    EXPECT_NEAR(middle - rim.begin, kBreadth, kSpacing);
    EXPECT_NEAR(middle - rim.end, 0.0F, kSpacing);
    ++sides[along_x ? (rim.p_H.y() > 0.0F ? 0U : 1U) : (rim.p_H.x() > 0.0F ? 2U : 3U)];
  }
  for (const int points : sides) {
    EXPECT_GT(points, 10);
  }
}

TEST_F(Hatch, ALandmarkFacesOneWayAndIsNotLargerThanATile) {
  std::vector<int> members(map().landmarks().size(), 0);
  std::vector<SurfaceClass> faces(map().landmarks().size(), SurfaceClass::other);
  std::vector<bool> of_rim(map().landmarks().size(), false);
  std::vector<Box> boxes(map().landmarks().size());
  const auto add = [&](std::uint32_t landmark, const Point& p_H) {
    ASSERT_LT(landmark, map().landmarks().size());
    Box& box = boxes[landmark];
    box = members[landmark]++ == 0 ? Box{p_H, p_H} : Box{box.min.cwiseMin(p_H), box.max.cwiseMax(p_H)};
  };
  for (const RimPoint& rim : map().rims()) {
    if (rim.landmark != Surfel::kNoLandmark) {
      add(rim.landmark, rim.p_H);
      of_rim[rim.landmark] = true;
    }
  }
  for (std::size_t i = 0; i < map().surfels().size(); ++i) {
    const Surfel& surfel = map().surfels()[i];
    if (surfel.landmark != Surfel::kNoLandmark) {
      EXPECT_TRUE(surfel.planar);
      EXPECT_FALSE(of_rim[surfel.landmark]) << "a rim's points are finer than surfels and apart from them";
      EXPECT_TRUE(members[surfel.landmark] == 0 || faces[surfel.landmark] == surfel.surface);
      faces[surfel.landmark] = surfel.surface;
      add(surfel.landmark, map().subset_H()[i]);
    }
  }
  EXPECT_GT(map().landmarks().size(), 20U);
  for (std::size_t landmark = 0; landmark < map().landmarks().size(); ++landmark) {
    EXPECT_EQ(of_rim[landmark], map().landmarks()[landmark].kind == LandmarkKind::rim) << landmark;
    EXPECT_LE((boxes[landmark].max - boxes[landmark].min).maxCoeff(), kTile + 0.01F) << landmark;
  }
}

TEST_F(Hatch, ProbesAreTheSubsetThenTheRims) {
  const std::size_t subset = map().subset_H().size();
  ASSERT_EQ(map().probes_H().size(), subset + map().rims().size());
  ASSERT_FALSE(map().rims().empty());
  for (std::size_t i = 0; i < map().probes_H().size(); ++i) {
    EXPECT_EQ(map().probes_H()[i], i < subset ? map().subset_H()[i] : map().rims()[i - subset].p_H) << i;
  }
}

TEST_F(Hatch, TheWallsUnderARimsEdgesAreTheCoamingsAndNothingElseIs) {
  std::array<int, 3> walls{};  // inner ones, transverse and longitudinal; outer ones
  for (std::size_t i = 0; i < map().subset_H().size(); ++i) {
    const Point& p = map().subset_H()[i];
    const Surfel& surfel = map().surfels()[i];
    if (surfel.landmark == Surfel::kNoLandmark) {
      continue;
    }
    const bool level = surfel.surface == SurfaceClass::horizontal;
    const float out = outside(p.x(), p.y());
    const bool inner = std::abs(out) < 0.1F;
    const bool outer = std::abs(out - kBreadth) < 0.1F && p.z() > 0.0F;
    const bool of_coaming = map().landmarks()[surfel.landmark].kind == LandmarkKind::coaming_wall;
    EXPECT_TRUE(!of_coaming || (!level && (inner || outer))) << p.transpose();
    if (of_coaming) {
      EXPECT_TRUE(surfel.backed);
      const bool along = surfel.surface == SurfaceClass::longitudinal;
      const int axis = along ? 1 : 0;
      const float outward = surfel.normal_H[axis] * std::copysign(1.0F, p[axis]);
      EXPECT_GT(inner ? -outward : outward, 0.9F) << p.transpose();
      ++walls[!inner ? 2U : along ? 1U : 0U];
    }
  }
  for (std::size_t i = 0; i < walls.size(); ++i) {
    EXPECT_GT(walls[i], 20) << i;
  }
}

TEST_F(Hatch, ACoamingsWallsAreSeenFromTheirOwnSideOnly) {
  int walls = 0;
  for (std::size_t i = 0; i < map().subset_H().size(); ++i) {
    const Point& p = map().subset_H()[i];
    const Surfel& surfel = map().surfels()[i];
    const bool between = std::abs(p.y()) < kHalfWidth - 1.0F && p.z() > 0.4F && p.z() < kTop - 0.4F;
    if (surfel.planar && !surfel.movable && between && surfel.surface == SurfaceClass::transverse) {
      EXPECT_TRUE(surfel.backed);
      const float outward = std::abs(p.x()) > kHalfLength + 0.5F * kBreadth ? 1.0F : -1.0F;
      EXPECT_GT(outward * std::copysign(1.0F, p.x()) * surfel.normal_H.x(), 0.9F) << p.transpose();
      ++walls;
    }
  }
  EXPECT_GT(walls, 20);
}

}  // namespace
}  // namespace hulltrack
