// What many noisy looks at one landmark come to; the looks are drawn here, the answers follow from the law's
// words.
#include "core/integrity/landmark_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace hulltrack {
namespace {

constexpr double kNoise = 0.03;  // m, of one return: the worst of our sensors

std::vector<Landmark> one(LandmarkKind kind) { return {{.kind = kind}}; }

class OneLandmark : public testing::Test {
 protected:
  OneLandmark() { memory.reset(one(LandmarkKind::surface)); }

  /// `n` returns of one frame from a surface `offset` off the mapped one.
  void see(double offset, int n) {
    std::normal_distribution<double> noise(offset, kNoise);
    for (int i = 0; i < n; ++i) {
      memory.add_offset(0, noise(random), 1.0);
    }
  }
  LandmarkState state() { return memory.judge(0).state; }

  std::mt19937 random{7};
  LandmarkMemory memory;
};

TEST_F(OneLandmark, TenCentimetresOffIsDisplacedAndTwoAreNot) {
  for (const double offset : {-0.30, -0.10, -0.02, 0.0, 0.02, 0.10, 0.30}) {
    memory.reset(one(LandmarkKind::surface));
    memory.begin_frame();
    see(offset, 60);
    EXPECT_EQ(state(), std::abs(offset) > 0.05 ? LandmarkState::displaced : LandmarkState::in_place)
        << offset;
    EXPECT_NEAR(memory.judge(0).offset, offset, 4.0 * 1.25 * kNoise / std::sqrt(60.0));
  }
}

TEST_F(OneLandmark, AFewReturnsSayNothing) {
  memory.begin_frame();
  see(0.2, 5);
  EXPECT_EQ(state(), LandmarkState::unknown);
}

TEST_F(OneLandmark, ACoverThatIsGoneIsNotDisplaced) {
  memory.begin_frame();
  see(-0.3, 30);  // the coaming that it lay on
  for (int i = 0; i < 30; ++i) {
    memory.add_through(0);
  }
  EXPECT_EQ(state(), LandmarkState::gone);
}

TEST_F(OneLandmark, CargoAgainstAWallIsNotDisplaced) {
  memory.begin_frame();
  std::uniform_real_distribution<double> slope(0.0, 0.5);
  for (int i = 0; i < 100; ++i) {
    memory.add_offset(0, slope(random), 1.0);
  }
  EXPECT_EQ(state(), LandmarkState::scattered);
}

TEST_F(OneLandmark, ARimThatIsHigherIsDisplacedUnlessItGoesOnOverTheHold) {
  for (const bool goes_on : {false, true}) {
    memory.reset(one(LandmarkKind::surface));
    memory.begin_frame();
    see(0.25, 40);
    for (int i = 0; i < 20; ++i) {
      memory.add_beside(0, goes_on);
    }
    EXPECT_EQ(state(), goes_on ? LandmarkState::covered : LandmarkState::displaced);
  }
}

TEST_F(OneLandmark, DisplacedOnceIsRememberedUntilSeenInPlace) {
  memory.begin_frame();
  see(0.15, 60);
  EXPECT_EQ(memory.report().displaced, 1U);
  memory.begin_frame();  // out of sight
  EXPECT_EQ(memory.report().displaced, 1U);
  for (int frame = 0; frame < 20; ++frame) {
    memory.begin_frame();
    see(0.0, 60);
    (void)memory.report();
  }
  EXPECT_EQ(memory.report().displaced, 0U) << "what was seen long ago is forgotten as new returns come";
}

class OneRim : public OneLandmark {
 protected:
  OneRim() { forget(); }
  void forget() { memory.reset(one(LandmarkKind::rim)); }
  /// A frame of rays over a coaming's top that stands `aside` of its place across, at its mapped height.
  void see_strip(float aside, int n) {
    memory.begin_frame();
    see(0.0, n / 2);
    std::uniform_real_distribution<float> across(-RimMemory::kAside, RimMemory::kAside);
    std::normal_distribution<float> blur(0.0F, 0.015F);
    for (int i = 0; i < n; ++i) {
      const float s = across(random);
      const float hit = s + blur(random) - aside;
      memory.add_across(rim, s, hit > rim.begin && hit < rim.end);
    }
  }

  RimPoint rim{Point::Zero(), Point::UnitY(), Point::UnitY(), -0.15F, 0.15F, 0};
};

TEST_F(OneRim, AsideByADecimetreIsADisplacedRimThoughItsHeightIsRight) {
  see_strip(0.0F, 300);
  LandmarkReport report = memory.report();
  EXPECT_EQ(report.displaced, 0U);
  EXPECT_EQ(report.displaced_rims, 0U);
  EXPECT_EQ(report.solid, 1U);
  EXPECT_TRUE(memory.judge_rim(0).in_place());

  forget();
  EXPECT_FALSE(memory.judge_rim(0).known) << "forgotten";
  see_strip(0.12F, 300);
  report = memory.report();
  EXPECT_EQ(state(), LandmarkState::in_place);
  EXPECT_EQ(report.displaced, 1U);
  EXPECT_EQ(report.displaced_rims, 1U);
  EXPECT_EQ(report.solid, 1U);
  EXPECT_NEAR(report.median_offset, 0.12, 0.02);
  EXPECT_NEAR(memory.judge_rim(0).shift, 0.12, 0.02);
}

TEST_F(OneRim, AsideOnceIsRememberedUntilSeenInPlace) {
  see_strip(-0.12F, 300);
  EXPECT_EQ(memory.report().displaced_rims, 1U);
  memory.begin_frame();  // out of sight
  EXPECT_EQ(memory.report().displaced_rims, 1U);
  for (int frame = 0; frame < 30; ++frame) {
    see_strip(0.0F, 100);
    (void)memory.report();
  }
  EXPECT_EQ(memory.report().displaced_rims, 0U);
}

TEST_F(OneRim, GoneFromItsPlaceItStandsElsewhere) {
  memory.begin_frame();
  see(0.0, 10);
  for (int i = 0; i < 40; ++i) {
    memory.add_through(0);
  }
  EXPECT_EQ(state(), LandmarkState::gone);
  LandmarkReport report = memory.report();
  EXPECT_EQ(report.displaced, 1U);
  EXPECT_EQ(report.displaced_rims, 1U);
  EXPECT_EQ(report.median_offset, 0.0) << "nobody knows where";
  for (int frame = 0; frame < 20; ++frame) {
    memory.begin_frame();
    see(0.0, 60);
    report = memory.report();
  }
  EXPECT_EQ(report.displaced, 0U);
}

class OneWall : public OneLandmark {
 protected:
  OneWall() { forget(); }
  void forget() { memory.reset(one(LandmarkKind::coaming_wall)); }
  /// A frame of rays at a coaming's wall that ended `offset` off its place, and of others over its top.
  LandmarkReport look(double offset, int n, int over) {
    memory.begin_frame();
    see(offset, n);
    for (int i = 0; i < over; ++i) {
      memory.add_through(0);
    }
    return memory.report();
  }
};

TEST_F(OneWall, BehindItsPlaceItIsSetBackHoweverManyRaysPassItsTop) {
  for (const auto& [n, over] : {std::pair{60, 0}, {45, 15}, {30, 30}, {0, 60}}) {
    forget();
    const LandmarkReport report = look(-0.3, n, over);
    EXPECT_EQ(state(), LandmarkState::set_back) << n << " and " << over;
    EXPECT_EQ(report.set_back, 1U);
    EXPECT_EQ(report.displaced, 1U);
    EXPECT_EQ(report.displaced_rims, 0U);
    EXPECT_EQ(report.solid, 1U);
    EXPECT_NEAR(report.median_offset, n > 0 ? 0.3 : 0.0, 0.03);
  }
}

TEST_F(OneWall, BeforeItsPlaceSomethingMayStand) {
  const LandmarkReport report = look(0.3, 60, 0);
  EXPECT_EQ(state(), LandmarkState::displaced);
  EXPECT_EQ(report.set_back, 0U);
}

TEST_F(OneWall, NeitherItsNoiseNorItsEdgesSetItBack) {
  for (int draw = 0; draw < 1000; ++draw) {
    forget();
    EXPECT_EQ(look(-0.02, 12, 0).set_back, 0U) << "the pose and the map are 2 cm off, twelve returns";
  }
  forget();
  EXPECT_EQ(look(0.0, 60, 40).set_back, 0U);
  EXPECT_EQ(state(), LandmarkState::scattered) << "two in five pass its edges";
}

TEST_F(OneWall, CargoBeforeHalfOfItDoesNotHideThatTheRestIsSetBack) {
  memory.begin_frame();
  std::uniform_real_distribution<double> slope(0.0, 0.5);
  for (int i = 0; i < 25; ++i) {
    memory.add_offset(0, slope(random), 1.0);
  }
  see(-0.3, 40);
  EXPECT_EQ(state(), LandmarkState::set_back);
}

TEST_F(OneWall, SetBackOnceIsRememberedUntilSeenInPlace) {
  EXPECT_EQ(look(-0.2, 60, 0).set_back, 1U);
  EXPECT_EQ(look(0.0, 0, 0).set_back, 1U) << "out of sight";
  LandmarkReport report;
  for (int frame = 0; frame < 20; ++frame) {
    report = look(0.0, 60, 0);
  }
  EXPECT_EQ(report.set_back, 0U);
  EXPECT_EQ(report.displaced, 0U);
}

TEST_F(OneLandmark, BehindItsPlaceNothingButAWallOfACoamingIsSetBack) {
  memory.begin_frame();
  see(-0.3, 60);
  EXPECT_EQ(state(), LandmarkState::displaced);
  EXPECT_EQ(memory.report().set_back, 0U);
}

TEST_F(OneLandmark, ASurfaceThatIsDisplacedAndNoRimIsCountedOnce) {
  memory.begin_frame();
  see(0.15, 60);
  const LandmarkReport report = memory.report();
  EXPECT_EQ(report.in_view, 1U);
  EXPECT_EQ(report.judged, 1U);
  EXPECT_EQ(report.solid, 1U);
  EXPECT_EQ(report.displaced, 1U);
  EXPECT_EQ(report.displaced_rims, 0U);
  EXPECT_NEAR(report.median_offset, 0.15, 0.02);
}

/// Six transverse walls of a hatch, hold 0, and four of a house 20 m off.
std::vector<Landmark> hatch_and_house() {
  std::vector<Landmark> mapped(10, Landmark{.faces = SurfaceClass::transverse});
  for (std::size_t i = 0; i < 6; ++i) {
    mapped[i].hold = 0;
  }
  for (std::size_t i = 6; i < 10; ++i) {
    mapped[i].place = -20.0F;
  }
  return mapped;
}

class Ship : public testing::Test {
 protected:
  explicit Ship(std::vector<Landmark> mapped = hatch_and_house()) { memory.reset(std::move(mapped)); }
  /// Frames of twenty returns on each of the landmarks from `begin` to `end`, `offset` off their planes.
  LandmarkReport look(std::uint32_t begin, std::uint32_t end, double offset = 0.0, int frames = 1) {
    LandmarkReport report;
    for (int frame = 0; frame < frames; ++frame) {
      memory.begin_frame();
      for (std::uint32_t landmark = begin; landmark < end; ++landmark) {
        memory.add_offset(landmark, offset, 20.0);
      }
      report = memory.report();
    }
    return report;
  }
  LandmarkMemory memory;
};

TEST_F(Ship, OneHatchInViewDoesNotDecideWhereTheMapHasMore) {
  EXPECT_FALSE(look(0, 6, 0.0, 50).decided);
  const LandmarkReport report = look(6, 8);
  EXPECT_EQ(report.along.in_place, 2U) << "the hatch is remembered";
  EXPECT_FALSE(report.decided) << "two landmarks are in view";
  EXPECT_TRUE(look(0, 10).decided);
  EXPECT_TRUE(look(0, 6).decided) << "once is enough";
}

TEST_F(Ship, WhereTheMapHasOneStructureOneDecides) {
  std::vector<Landmark> mapped = hatch_and_house();
  mapped.resize(6);
  mapped.insert(mapped.end(), 4, Landmark{.faces = SurfaceClass::transverse, .place = 1.0F, .hold = 0});
  memory.reset(mapped);
  EXPECT_TRUE(look(0, 10, 0.0, 20).decided);
}

TEST_F(Ship, WithoutATopOfACoamingInPlaceTheHatchesHeightIsNotKnown) {
  std::vector<Landmark> mapped = hatch_and_house();
  mapped.push_back({.kind = LandmarkKind::rim, .faces = SurfaceClass::transverse, .hold = 0});
  memory.reset(mapped);
  EXPECT_FALSE(look(0, 10, 0.0, 50).decided);
  EXPECT_EQ(look(0, 11).rims_in_place, 1U);
  EXPECT_TRUE(look(0, 11).decided);
}

TEST_F(Ship, AHouseSeenInPlaceBeforeThePoseJumpedIsElsewhereSince) {
  EXPECT_EQ(look(6, 10).along.in_place, 1U);
  memory.put_elsewhere({0.24F, 0.0F, 0.0F});  // onto a hatch that lies 0.24 m aside of its place
  LandmarkReport report = look(0, 6);
  EXPECT_EQ(report.along.in_place, 1U);
  EXPECT_EQ(report.along.displaced, 1U);
  memory.put_elsewhere({-0.24F, 0.0F, 0.0F});
  report = look(6, 8);
  EXPECT_EQ(report.along.in_place, 1U) << "the house, and it was never seen elsewhere";
  EXPECT_EQ(report.along.displaced, 1U) << "the hatch";
}

TEST_F(Ship, ARimThatWasInLineIsElsewhereAfterAJumpThoughItsHeightIsSeen) {
  std::vector<Landmark> mapped = hatch_and_house();
  mapped[0].kind = LandmarkKind::rim;
  memory.reset(mapped);
  const RimPoint rim{Point::Zero(), Point::UnitX(), Point::UnitX(), -0.15F, 0.15F, 0};
  memory.begin_frame();
  for (int i = 0; i < 100; ++i) {
    const float s = -0.295F + 0.0059F * static_cast<float>(i);
    memory.add_across(rim, s, std::abs(s) < 0.15F);
  }
  memory.add_offset(0, 0.0, 20.0);
  EXPECT_EQ(memory.report().along.in_place, 1U);
  memory.put_elsewhere({0.24F, 0.0F, 0.0F});
  LandmarkReport report = look(0, 1);
  EXPECT_EQ(report.along.displaced, 1U);
  EXPECT_EQ(report.rims_in_place, 1U);
  memory.put_elsewhere({0.0F, 0.0F, 0.2F});
  report = look(6, 10);
  EXPECT_EQ(report.rims_in_place, 0U) << "its height neither";
}

TEST_F(Ship, AJumpAcrossLeavesWhatStandsAlong) {
  (void)look(6, 10);
  memory.put_elsewhere({0.0F, 0.24F, 0.1F});
  EXPECT_EQ(look(0, 6).along.in_place, 2U);
}

TEST_F(Ship, ReturnsOfBeforeAJumpAreDropped) {
  (void)look(0, 6, 0.0, 20);
  memory.put_elsewhere({0.24F, 0.0F, 0.0F});
  EXPECT_EQ(look(0, 6, -0.24).along.displaced, 1U) << "twenty new returns";
}

TEST(LandmarkMemory, TheShipIsDecidedOnWhenMostOfWhatIsInViewWasJudgedInSeveralFrames) {
  LandmarkMemory memory;
  memory.reset(std::vector<Landmark>(10));
  int frames = 0;
  for (bool decided = false; !decided && frames < 100; ++frames) {
    memory.begin_frame();
    for (std::uint32_t landmark = 0; landmark < 10; ++landmark) {
      memory.add_offset(landmark, 0.0, landmark < 7 ? 20.0 : 0.5);  // three are seen rarely
    }
    decided = memory.report().decided;
  }
  EXPECT_EQ(frames, 24) << "12 returns of the rare ones, half a return a frame";
  memory.reset(std::vector<Landmark>(10));
  memory.begin_frame();
  EXPECT_FALSE(memory.report().decided);
}

}  // namespace
}  // namespace hulltrack
