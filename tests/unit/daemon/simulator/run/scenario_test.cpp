#include "daemon/simulator/run/scenario.hpp"

#include <gtest/gtest.h>

#include <set>

#include "daemon/simulator/run/simulated_berth.hpp"

namespace hulltrack {
namespace {

/// Largest speed of the reference point over a scenario's own run, m/s.
double top_speed(const std::string& name) {
  const auto berth = std::move(SimulatedBerth::create({.scenario = name})).value();
  double top = 0.0;
  constexpr auto kStep = std::chrono::milliseconds(100);
  for (int frame = 0; frame < berth->frames(); ++frame) {
    const ShipPose here = berth->truth(frame * kStep);
    const ShipPose then = berth->truth((frame + 1) * kStep);
    const double moved = (then.displacement - here.displacement).norm();
    top = std::max(top, moved / to_seconds(kStep));
  }
  return top;
}

TEST(Scenario, NamesAreUniqueAndExplainThemselves) {
  std::set<std::string_view> names;
  for (const Scenario& scenario : scenarios()) {
    EXPECT_TRUE(names.insert(scenario.name).second) << scenario.name;
    EXPECT_EQ(find_scenario(scenario.name), &scenario);
    EXPECT_GT(scenario.sentence.size(), 20U) << scenario.name;
    EXPECT_TRUE(scenario.sentence.ends_with('.')) << scenario.name;
    EXPECT_GE(scenario.frames, 100) << scenario.name;
  }
  EXPECT_EQ(find_scenario("nowhere"), nullptr);
  EXPECT_EQ(find_scenario("berth")->frames, 869);  // Guo 2025, 3.1
}

TEST(Scenario, MooredShipsKeepBelowTheUsualSpeedLimitAndLeavingOnesPassIt) {
  constexpr double kUsualLimit = 0.3;  // m/s, hull.max_speed
  for (const char* name : {"mooring", "draft", "heel", "trim", "surge-jerk", "passing-ship", "shift", "creep",
                           "cargo", "hog", "sag", "night-shift"})
    EXPECT_LT(top_speed(name), kUsualLimit) << name;
  for (const char* name : {"berth", "surge-jerk-fast", "depart-astern", "depart-sideways"})
    EXPECT_GT(top_speed(name), kUsualLimit) << name;
}

TEST(Scenario, ShipsAreWhereTheirSentencesSay) {
  const auto end_of = [](const char* name) {
    const auto berth = std::move(SimulatedBerth::create({.scenario = name})).value();
    return berth->truth(berth->frames() * SimulatedBerth::kFramePeriod);
  };
  EXPECT_NEAR(end_of("shift").displacement.x(), 22.6, 0.2);
  EXPECT_NEAR(end_of("warp-blind").displacement.x(), 22.6, 0.2);
  EXPECT_NEAR(end_of("drift-blind").displacement.x(), 6.0, 0.2);
  EXPECT_LT(end_of("draft").displacement.z(), -6.8);
  EXPECT_NEAR(end_of("trim").rpy.y(), radians(0.9), radians(0.1));
  EXPECT_NEAR(end_of("creep").displacement.y(), 3.5, 0.2);
  EXPECT_NEAR(end_of("surge-jerk").displacement.x(), 0.0, 0.1);
}

TEST(Scenario, BlindSpellsHideTheWholeOfTheShipsDrift) {
  for (const char* name : {"warp-blind", "drift-blind"}) {
    const Scenario& scenario = *find_scenario(name);
    const HullMotion motion(scenario.motion, Eigen::Vector3d::Zero(), 1);
    const double begin = scenario.cover.when.first;
    const double end = begin + scenario.cover.when.length;
    const auto moved = [&](double from, double to) {
      return (motion.pose(to).displacement - motion.pose(from).displacement).norm();
    };
    EXPECT_LT(moved(0.0, begin), 0.05) << name;
    EXPECT_GT(moved(begin, end), 6.0) << name;
    EXPECT_LT(moved(end, end + 5.0), 0.05) << name;
    EXPECT_GT(0.1 * scenario.frames, end + 5.0) << name;
  }
}

TEST(Scenario, ClearMeansThatNothingEverComesBetween) {
  EXPECT_TRUE(is_clear(*find_scenario("berth")));
  EXPECT_TRUE(is_clear(*find_scenario("crane")));
  for (const char* name :
       {"rain", "rain-heavy", "fog", "dust", "blocked-window", "warp-blind", "night-shift"})
    EXPECT_FALSE(is_clear(*find_scenario(name))) << name;
}

TEST(Scenario, SistersDifferByTenToThirtyCentimetresAndInNothingElse) {
  const ShipDesign ship = berth_ship();
  const auto tenth_to_third = [](float difference) {
    return std::abs(difference) > 0.099F && std::abs(difference) < 0.301F;
  };
  const ShipDesign moved = sister_with_other_hatch_places();
  const ShipDesign higher = sister_with_other_coamings();
  const ShipDesign wider = sister_with_other_openings();
  for (std::size_t i = 0; i < ship.hatches.size(); ++i) {
    const Hatch& own = ship.hatches[i];
    EXPECT_TRUE(tenth_to_third(moved.hatches[i].centre - own.centre));
    EXPECT_EQ(moved.hatches[i].coaming_height, own.coaming_height);
    EXPECT_TRUE(tenth_to_third(higher.hatches[i].coaming_height - own.coaming_height));
    EXPECT_EQ(higher.hatches[i].centre, own.centre);
    EXPECT_TRUE(tenth_to_third(wider.hatches[i].length - own.length));
    EXPECT_TRUE(tenth_to_third(wider.hatches[i].width - own.width));
  }
}

}  // namespace
}  // namespace hulltrack
