#include "core/geometry/block_index.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

namespace hulltrack {
namespace {

TEST(BlockIndex, NumbersAreThoseOfAnOrderedTable) {
  std::mt19937 random(1);
  std::map<std::array<int, 3>, std::uint32_t> expected;
  BlockIndex index;
  for (const int reach : {3, 100, BlockIndex::kFarthest}) {
    std::uniform_int_distribution<int> coordinate(-reach, reach);
    for (int i = 0; i < 3000; ++i) {
      const std::array<int, 3> block{coordinate(random), coordinate(random), coordinate(random)};
      const auto number = static_cast<std::uint32_t>(expected.size());
      EXPECT_EQ(index.add(block[0], block[1], block[2]), expected.try_emplace(block, number).first->second);
    }
  }
  EXPECT_EQ(index.size(), expected.size());
  for (const auto& [block, number] : expected) {
    ASSERT_EQ(index.find(block[0], block[1], block[2]), number);
  }
}

TEST(BlockIndex, WhatWasNeverAddedHasNoNumber) {
  BlockIndex index;
  EXPECT_EQ(index.find(0, 0, 0), BlockIndex::kNone);
  for (int x = -10; x <= 10; ++x) {
    index.add(x, 0, -x);
  }
  for (int x = -10; x <= 10; ++x) {
    EXPECT_EQ(index.find(x, 1, -x), BlockIndex::kNone);
    EXPECT_EQ(index.find(x, 0, -x + 1), BlockIndex::kNone);
  }
  EXPECT_EQ(index.find(BlockIndex::kFarthest, -BlockIndex::kFarthest, 0), BlockIndex::kNone);
}

}  // namespace
}  // namespace hulltrack
