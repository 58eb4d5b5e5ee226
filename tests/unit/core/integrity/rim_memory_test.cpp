// Where a rim lies across its length, from rays that are drawn evenly over it and the air beside it.
#include "core/integrity/rim_memory.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hulltrack {
namespace {

constexpr float kBegin = -0.175F;
constexpr float kEnd = 0.175F;

/// `n` rays, each blurred by a beam of 3 cm, at a rim that lies `shift` beside its place.
RimMemory look_at(float shift, int n, float end = kEnd) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> across(-RimMemory::kAside, RimMemory::kAside);
  std::normal_distribution<float> blur(0.0F, 0.015F);
  RimMemory memory;
  for (int i = 0; i < n; ++i) {
    const float s = across(random);
    const float hit = s + blur(random);
    memory.add(s, hit > kBegin + shift && hit < end + shift);
  }
  return memory;
}

TEST(RimMemory, FindsTheShiftOfAStrip) {
  for (const float shift : {-0.25F, -0.10F, 0.0F, 0.02F, 0.10F, 0.25F}) {
    const auto finding = look_at(shift, 300).judge(kBegin, kEnd);
    ASSERT_TRUE(finding.known);
    EXPECT_NEAR(finding.shift, shift, 0.03) << shift;
    EXPECT_EQ(finding.displaced(), std::abs(shift) >= 0.10F) << shift;
    EXPECT_EQ(finding.in_place(), std::abs(shift) < 0.10F) << shift;
  }
}

TEST(RimMemory, WhatJoinsAStripAtOneSideMovesNothing) {
  EXPECT_FALSE(look_at(0.0F, 400, 0.3F).judge(kBegin, kEnd).displaced());  // cargo up to the brim
}

TEST(RimMemory, FewRaysSayNothing) { EXPECT_FALSE(look_at(0.2F, 20).judge(kBegin, kEnd).known); }

TEST(RimMemory, WhatWasSeenIsForgottenAsNewRaysCome) {
  RimMemory memory = look_at(0.2F, 400);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> across(-RimMemory::kAside, RimMemory::kAside);
  for (int frame = 0; frame < 30; ++frame) {
    memory.begin_frame();
    for (int i = 0; i < 100; ++i) {
      const float s = across(random);
      memory.add(s, s > kBegin && s < kEnd);
    }
  }
  EXPECT_NEAR(memory.judge(kBegin, kEnd).shift, 0.0, 0.015);
}

}  // namespace
}  // namespace hulltrack
