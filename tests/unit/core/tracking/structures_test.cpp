#include "core/tracking/structures.hpp"

#include <gtest/gtest.h>

#include "core/map/relief.hpp"

namespace hulltrack {
namespace {

constexpr std::uint32_t kNone = Relief::kNoPit;

TEST(Structures, AllThatBelongsToAHatchIsOne) {
  const StructureCount count =
      count_structures({{0, -9.0F, false}, {0, 9.0F, false}, {1, 13.0F, false}, {0, -8.7F, false}});
  EXPECT_EQ(count.in_place, 2U);
  EXPECT_EQ(count.displaced, 0U);
}

TEST(Structures, WhatIsOfNoHatchIsOneAsFarAsItGoesOn) {
  const StructureCount count = count_structures({{kNone, -48.0F, false},
                                                 {kNone, 43.0F, false},
                                                 {kNone, -45.5F, false},
                                                 {kNone, -47.1F, false},
                                                 {kNone, -46.3F, false}});
  EXPECT_EQ(count.in_place, 2U) << "a house with steps, a forecastle";
}

TEST(Structures, MostOfItsPatchesDecide) {
  EXPECT_EQ(count_structures({{0, 1.0F, true}, {0, 2.0F, true}, {0, 3.0F, false}}).displaced, 1U);
  EXPECT_EQ(count_structures({{0, 1.0F, true}, {0, 2.0F, false}, {0, 3.0F, false}}).in_place, 1U);
  const StructureCount even = count_structures({{0, 1.0F, true}, {0, 2.0F, false}});
  EXPECT_EQ(even.in_place + even.displaced, 0U) << "as many for as against";
}

TEST(Structures, OfNothingThereAreNone) {
  const StructureCount count = count_structures({});
  EXPECT_EQ(count.in_place, 0U);
  EXPECT_EQ(count.displaced, 0U);
}

}  // namespace
}  // namespace hulltrack
