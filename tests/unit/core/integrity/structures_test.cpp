#include "core/integrity/structures.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hulltrack {
namespace {

constexpr auto kAlong = SurfaceClass::transverse;
constexpr auto kAcross = SurfaceClass::longitudinal;

Landmark landmark(float place, std::uint32_t hold = Relief::kNoHold, SurfaceClass faces = kAlong) {
  return {.faces = faces, .place = place, .hold = hold};
}

TEST(Structures, AllThatBelongsToAHatchIsOne) {
  const std::vector<Landmark> mapped{landmark(-9.0F, 0), landmark(9.0F, 0), landmark(13.0F, 1),
                                     landmark(-8.7F, 0)};
  EXPECT_EQ(Structures(mapped).mapped(kAlong), 2U);
}

TEST(Structures, WhatIsOfNoHatchIsOneAsFarAsItGoesOn) {
  const std::vector<Landmark> mapped{landmark(-48.0F), landmark(43.0F), landmark(-45.5F), landmark(-47.1F),
                                     landmark(-46.3F)};
  EXPECT_EQ(Structures(mapped).mapped(kAlong), 2U) << "a house with steps, a forecastle";
}

TEST(Structures, AHousesStepsAreOneThoughThoseBetweenAreNotInView) {
  const std::vector<Landmark> mapped{landmark(-48.0F), landmark(-46.5F), landmark(-45.0F)};
  Structures structures(mapped);
  structures.vote(0, false);
  structures.vote(2, false);
  EXPECT_EQ(structures.count(kAlong).in_place, 1U);
}

TEST(Structures, EachDirectionHasItsOwn) {
  const std::vector<Landmark> mapped{landmark(0.0F, 0), landmark(5.0F, 0, kAcross), landmark(9.0F),
                                     landmark(9.0F, Relief::kNoHold, SurfaceClass::other)};
  Structures structures(mapped);
  EXPECT_EQ(structures.mapped(kAlong), 2U);
  EXPECT_EQ(structures.mapped(kAcross), 1U);
  structures.vote(1, true);
  structures.vote(2, false);
  structures.vote(3, false);
  EXPECT_EQ(structures.count(kAlong).in_place, 1U);
  EXPECT_EQ(structures.count(kAlong).displaced, 0U);
  EXPECT_EQ(structures.count(kAcross).displaced, 1U);
}

TEST(Structures, MostOfItsLandmarksDecide) {
  const std::vector<Landmark> mapped{landmark(1.0F, 0), landmark(2.0F, 0), landmark(3.0F, 0)};
  Structures structures(mapped);
  structures.vote(0, true);
  structures.vote(1, false);
  EXPECT_EQ(structures.count(kAlong).in_place + structures.count(kAlong).displaced, 0U)
      << "as many for as against";
  structures.vote(2, true);
  EXPECT_EQ(structures.count(kAlong).displaced, 1U);
  structures.clear_votes();
  structures.vote(2, false);
  EXPECT_EQ(structures.count(kAlong).in_place, 1U);
  EXPECT_EQ(structures.count(kAlong).displaced, 0U);
}

TEST(Structures, OfNothingThereAreNone) {
  const Structures structures;
  EXPECT_EQ(structures.mapped(kAlong), 0U);
  EXPECT_EQ(structures.count(kAlong).in_place, 0U);
}

}  // namespace
}  // namespace hulltrack
