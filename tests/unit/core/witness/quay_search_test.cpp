#include "core/witness/quay_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

const Joints kWorking{0.0, radians(80.0), radians(-2.0)};
constexpr int kRound = 20;  // frames: all guesses, and some more

/// A cabinet of a metre and a half on a quay, which has no flat side that is seen.
struct Thing {
  float x, y;
};
const std::vector<Thing> kThings = {{-38.0F, -2.0F}, {-21.0F, -15.0F}, {-9.0F, -3.0F}, {2.0F, -16.0F},
                                    {13.0F, -2.0F},  {27.0F, -15.0F},  {44.0F, -3.0F}};

void add_thing(Cloud& cloud, const Thing& at, int points, std::mt19937& random) {
  std::uniform_real_distribution<float> turn(0.0F, 6.28F);
  std::uniform_real_distribution<float> height(0.2F, 1.5F);
  for (int i = 0; i < points; ++i) {
    const float angle = turn(random);
    cloud.emplace_back(at.x + 0.3F * std::cos(angle), at.y + 0.3F * std::sin(angle), height(random));
  }
}

void add_ground(Cloud& cloud, float x0, float x1, float step) {
  for (float x = x0; x < x1; x += step) {
    for (float y = -20.0F; y < 0.0F; y += step) {
      cloud.emplace_back(x, y, 0.0F);
    }
  }
}

const QuayMap& map() {
  static const QuayMap quay = [] {
    std::mt19937 random(1);
    Cloud cloud;
    add_ground(cloud, -60.0F, 60.0F, 0.1F);
    for (const Thing& thing : kThings) {
      add_thing(cloud, thing, 600, random);
    }
    return QuayMap(cloud);
  }();
  return quay;
}

/// What a scan of it shows, `each` returns of a thing, with `besides` of no map.
Cloud returns(unsigned seed, const std::vector<Thing>& things, const std::vector<Thing>& besides, int each) {
  std::mt19937 random(seed);
  Cloud cloud;
  add_ground(cloud, -55.0F, 55.0F, 1.3F);
  for (const Thing& thing : things) {
    add_thing(cloud, thing, each, random);
  }
  for (const Thing& thing : besides) {
    add_thing(cloud, thing, 40, random);
  }
  return cloud;
}

Cloud moved(Cloud cloud, const Pose& E) {
  for (Point& p : cloud) {
    p = (E * p.cast<double>()).cast<float>();
  }
  return cloud;
}

class Looks {
 public:
  explicit Looks(int returns_of_a_thing = 12) : each_(returns_of_a_thing) {}

  /// The last of so many frames of a machine whose joints read too much.
  std::optional<QuaySearch::Elsewhere> run(int frames, const Joints& too_much,
                                           const std::vector<Thing>& things = kThings,
                                           const std::vector<Thing>& besides = {}) {
    std::optional<QuaySearch::Elsewhere> found;
    for (int i = 0; i < frames; ++i) {
      const Joints reported{kWorking.d_x + too_much.d_x, kWorking.theta_r + too_much.theta_r,
                            kWorking.theta_p + too_much.theta_p};
      const Cloud returns_W =
          moved(returns(seed_++, things, besides, each_), testing::misplaced(reported, kWorking));
      search_.see(map(), returns_W, observer_.observe(map(), returns_W, {80, 80, 60, 40}),
                  testing::quay_machine(), testing::stand_at(reported), false);
      found = search_.look(map(), testing::quay_machine());
    }
    return found;
  }
  QuaySearch& search() { return search_; }

 private:
  int each_;
  unsigned seed_ = 0;
  QuayObserver observer_;
  QuaySearch search_;
};

TEST(QuaySearch, ThingsThatAreNoWallsTellOfATravelAndOfASlew) {
  for (const double off : {0.9, -1.3, 2.2, -4.8}) {
    Looks looks;
    const auto found = looks.run(kRound + 5, {off, 0.0, 0.0});
    ASSERT_TRUE(found) << off;
    ASSERT_TRUE(found->guess.joint == JointName::travel) << off;
    EXPECT_NEAR(found->guess.amount, off, 0.36) << "a step";
    EXPECT_TRUE(found->lasting);
  }
  for (const double off : {1.1, -2.4}) {
    Looks looks;
    const auto found = looks.run(kRound + 5, {0.0, radians(off), 0.0});
    ASSERT_TRUE(found) << off;
    EXPECT_TRUE(found->guess.joint == JointName::slew || !found->guess.joint) << "or a mount that is turned";
    EXPECT_NEAR(degrees(found->guess.amount), off, 0.61) << "two steps";
  }
}

TEST(QuaySearch, EveryReturnOfAFrameIsAsked) {
  Looks looks(2);  // of a thing: 14 among 1,360 of the ground
  const auto found = looks.run(kRound, {2.2, 0.0, 0.0});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->guess.joint == JointName::travel);
}

TEST(QuaySearch, AMachineThatIsRightIsBetterNowhere) {
  Looks looks;
  for (int i = 0; i < 3 * kRound; ++i) {
    EXPECT_FALSE(looks.run(1, {}, kThings, {{-30.0F, -8.0F}, {-3.0F, -8.0F}, {20.0F, -9.0F}, {35.0F, -8.0F}}))
        << i;
  }
  EXPECT_TRUE(looks.search().would_find(JointName::travel));
  EXPECT_TRUE(looks.search().would_find(JointName::luff)) << "of which the ground tells";
}

TEST(QuaySearch, SoIsOneWithinItsClass) {
  Looks looks;
  for (int i = 0; i < 2 * kRound; ++i) {
    const auto found = looks.run(1, {0.13, radians(0.2), radians(0.2)});
    EXPECT_FALSE(found && found->guess.beyond_wear) << i;
  }
}

TEST(QuaySearch, OneThingMayStandBesideWhereAnotherIs) {
  const std::vector<Thing> one = {kThings[2]};
  Looks looks;
  for (int i = 0; i < 2 * kRound; ++i) {
    EXPECT_FALSE(looks.run(1, {2.2, 0.0, 0.0}, one)) << i;
  }
  Looks honest;
  (void)honest.run(2 * kRound, {}, one);
  EXPECT_FALSE(honest.search().would_find(JointName::travel)) << "and so it would not be found";
}

TEST(QuaySearch, WhatStandsWhereTheMapDoesNotReachIsNoOtherPlace) {
  // Bollards go on beyond the surveyed end, each where the first one in the map would be after some travel.
  const std::vector<Thing> beyond = {{62.5F, -2.0F},  {62.5F, -5.0F},  {62.5F, -8.0F}, {62.5F, -11.0F},
                                     {62.5F, -14.0F}, {62.5F, -17.0F}, {62.5F, -19.0F}};
  Looks looks;
  for (int i = 0; i < 2 * kRound; ++i) {
    EXPECT_FALSE(looks.run(1, {}, {}, beyond)) << i;
  }
}

TEST(QuaySearch, SaysWhetherAPlaceIsWorseThanWhereTheMachineIsSaidToBe) {
  const MachineGuess travel{.joint = JointName::travel, .amount = 1.5};
  const Twist off = twist_of(travel, testing::quay_machine(), testing::stand_at(kWorking));
  Looks honest;
  (void)honest.run(3, {});
  EXPECT_TRUE(honest.search().look_there(map(), off).worse);
  EXPECT_TRUE(honest.search().look_there(map(), off).refuted);
  Looks wrong;
  (void)wrong.run(3, {1.5, 0.0, 0.0});
  EXPECT_FALSE(wrong.search().look_there(map(), off).worse);
  Looks blind;
  (void)blind.run(3, {1.5, 0.0, 0.0}, {});
  EXPECT_FALSE(blind.search().look_there(map(), off).worse) << "of ground alone nobody knows";
}

TEST(QuaySearch, ForgettingBeginsAnew) {
  Looks looks;
  ASSERT_TRUE(looks.run(kRound, {2.2, 0.0, 0.0}));
  looks.search().forget();
  EXPECT_FALSE(looks.search().look(map(), testing::quay_machine())) << "nothing of what was seen before";
  EXPECT_FALSE(looks.run(1, {}));
  EXPECT_FALSE(looks.search().would_find(JointName::travel));
}

}  // namespace
}  // namespace hulltrack
