// What many noisy looks at one patch come to; the looks are drawn here, the answers follow from the law's
// words.
#include "core/tracking/patch_evidence.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hulltrack {
namespace {

constexpr double kNoise = 0.03;  // m, of one return: the worst of our sensors

class OnePatch : public testing::Test {
 protected:
  OnePatch() { evidence.reset(1); }

  /// `n` returns of one frame from a surface `offset` off the mapped one.
  void see(double offset, int n) {
    std::normal_distribution<double> noise(offset, kNoise);
    for (int i = 0; i < n; ++i) {
      evidence.add_offset(0, noise(random), 1.0);
    }
  }
  PatchState state() { return evidence.judge(0).state; }

  std::mt19937 random{7};
  PatchEvidence evidence;
};

TEST_F(OnePatch, TenCentimetresOffIsDisplacedAndTwoAreNot) {
  for (const double offset : {-0.30, -0.10, -0.02, 0.0, 0.02, 0.10, 0.30}) {
    evidence.reset(1);
    evidence.begin_frame();
    see(offset, 60);
    EXPECT_EQ(state(), std::abs(offset) > 0.05 ? PatchState::displaced : PatchState::in_place) << offset;
    EXPECT_NEAR(evidence.judge(0).offset, offset, 4.0 * 1.25 * kNoise / std::sqrt(60.0));
  }
}

TEST_F(OnePatch, AFewReturnsSayNothing) {
  evidence.begin_frame();
  see(0.2, 5);
  EXPECT_EQ(state(), PatchState::unknown);
}

TEST_F(OnePatch, ACoverThatIsGoneIsNotDisplaced) {
  evidence.begin_frame();
  see(-0.3, 30);  // the coaming that it lay on
  for (int i = 0; i < 30; ++i) {
    evidence.add_through(0);
  }
  EXPECT_EQ(state(), PatchState::gone);
}

TEST_F(OnePatch, CargoAgainstAWallIsNotDisplaced) {
  evidence.begin_frame();
  std::uniform_real_distribution<double> slope(0.0, 0.5);
  for (int i = 0; i < 100; ++i) {
    evidence.add_offset(0, slope(random), 1.0);
  }
  EXPECT_EQ(state(), PatchState::scattered);
}

TEST_F(OnePatch, ARimThatIsHigherIsDisplacedUnlessItGoesOnOverTheHold) {
  for (const bool goes_on : {false, true}) {
    evidence.reset(1);
    evidence.begin_frame();
    see(0.25, 40);
    for (int i = 0; i < 20; ++i) {
      evidence.add_beside(0, goes_on);
    }
    EXPECT_EQ(state(), goes_on ? PatchState::covered : PatchState::displaced);
  }
}

TEST_F(OnePatch, DisplacedOnceIsRememberedUntilSeenInPlace) {
  evidence.begin_frame();
  see(0.15, 60);
  EXPECT_EQ(evidence.report().displaced, 1U);
  evidence.begin_frame();  // out of sight
  EXPECT_EQ(evidence.report().displaced, 1U);
  for (int frame = 0; frame < 20; ++frame) {
    evidence.begin_frame();
    see(0.0, 60);
    (void)evidence.report();
  }
  EXPECT_EQ(evidence.report().displaced, 0U) << "what was seen long ago is forgotten as new returns come";
}

class OneRim : public OnePatch {
 protected:
  OneRim() { forget(); }
  void forget() {
    evidence.reset(1);
    evidence.mark_rim(0);
  }
  /// A frame of rays over a coaming's top that stands `aside` of its place across, at its mapped height.
  void see_strip(float aside, int n) {
    evidence.begin_frame();
    see(0.0, n / 2);
    std::uniform_real_distribution<float> across(-StripEvidence::kAside, StripEvidence::kAside);
    std::normal_distribution<float> blur(0.0F, 0.015F);
    for (int i = 0; i < n; ++i) {
      const float s = across(random);
      const float hit = s + blur(random) - aside;
      evidence.add_across(rim, s, hit > rim.begin && hit < rim.end);
    }
  }

  RimPoint rim{Point::Zero(), Point::UnitY(), Point::UnitY(), -0.15F, 0.15F, 0};
};

TEST_F(OneRim, AsideByADecimetreIsADisplacedRimThoughItsHeightIsRight) {
  see_strip(0.0F, 300);
  PatchReport report = evidence.report();
  EXPECT_EQ(report.displaced, 0U);
  EXPECT_EQ(report.displaced_rims, 0U);
  EXPECT_EQ(report.solid, 1U);
  EXPECT_TRUE(evidence.judge_strip(0).in_place());

  forget();
  EXPECT_FALSE(evidence.judge_strip(0).known) << "forgotten";
  see_strip(0.12F, 300);
  report = evidence.report();
  EXPECT_EQ(state(), PatchState::in_place);
  EXPECT_EQ(report.displaced, 1U);
  EXPECT_EQ(report.displaced_rims, 1U);
  EXPECT_EQ(report.solid, 1U);
  EXPECT_NEAR(report.median_offset, 0.12, 0.02);
  EXPECT_NEAR(evidence.judge_strip(0).shift, 0.12, 0.02);
}

TEST_F(OneRim, AsideOnceIsRememberedUntilSeenInPlace) {
  see_strip(-0.12F, 300);
  EXPECT_EQ(evidence.report().displaced_rims, 1U);
  evidence.begin_frame();  // out of sight
  EXPECT_EQ(evidence.report().displaced_rims, 1U);
  for (int frame = 0; frame < 30; ++frame) {
    see_strip(0.0F, 100);
    (void)evidence.report();
  }
  EXPECT_EQ(evidence.report().displaced_rims, 0U);
}

TEST_F(OneRim, GoneFromItsPlaceItStandsElsewhere) {
  evidence.begin_frame();
  see(0.0, 10);
  for (int i = 0; i < 40; ++i) {
    evidence.add_through(0);
  }
  EXPECT_EQ(state(), PatchState::gone);
  PatchReport report = evidence.report();
  EXPECT_EQ(report.displaced, 1U);
  EXPECT_EQ(report.displaced_rims, 1U);
  EXPECT_EQ(report.median_offset, 0.0) << "nobody knows where";
  for (int frame = 0; frame < 20; ++frame) {
    evidence.begin_frame();
    see(0.0, 60);
    report = evidence.report();
  }
  EXPECT_EQ(report.displaced, 0U);
}

TEST_F(OnePatch, ASurfaceThatIsDisplacedAndNoRimIsCountedOnce) {
  evidence.begin_frame();
  see(0.15, 60);
  const PatchReport report = evidence.report();
  EXPECT_EQ(report.in_view, 1U);
  EXPECT_EQ(report.judged, 1U);
  EXPECT_EQ(report.solid, 1U);
  EXPECT_EQ(report.displaced, 1U);
  EXPECT_EQ(report.displaced_rims, 0U);
  EXPECT_NEAR(report.median_offset, 0.15, 0.02);
}

TEST(PatchEvidence, TheShipIsDecidedOnWhenMostOfWhatIsInViewWasJudgedInSeveralFrames) {
  PatchEvidence evidence;
  evidence.reset(10);
  int frames = 0;
  for (bool decided = false; !decided && frames < 100; ++frames) {
    evidence.begin_frame();
    for (std::uint32_t patch = 0; patch < 10; ++patch) {
      evidence.add_offset(patch, 0.0, patch < 7 ? 20.0 : 0.5);  // three are seen rarely
    }
    decided = evidence.report().decided;
  }
  EXPECT_EQ(frames, 24) << "12 returns of the rare ones, half a return a frame";
  evidence.reset(10);
  evidence.begin_frame();
  EXPECT_FALSE(evidence.report().decided);
}

}  // namespace
}  // namespace hulltrack
