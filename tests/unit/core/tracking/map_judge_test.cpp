#include "core/tracking/map_judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/support/analytic_ship.hpp"

namespace hulltrack {
namespace {

using hulltrack::testing::bulk_carrier_map;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Of a key: the messages, refusals marked.
std::string told(const std::vector<MapFinding>& findings, const std::string& key) {
  std::string text;
  for (const MapFinding& finding : findings) {
    text += finding.key == key ? (finding.refused ? "refused: " : "warning: ") + finding.message + "\n" : "";
  }
  return text;
}

const Cloud& ship() { return bulk_carrier_map()->cloud_H(); }

/// A configuration that suits the ship.
TrackerConfig config() {
  TrackerConfig config;
  config.hull.reference_point = ship().front().cast<double>();
  return config;
}

Cloud times(const Cloud& cloud, float factor) {
  Cloud scaled;
  for (const Point& p : cloud) {
    scaled.push_back(factor * p);
  }
  return scaled;
}

/// A box of this size, closed, a point every `step`.
Cloud box(const Point& size, float step) {
  Cloud cloud;
  for (float x = 0.0F; x <= size.x(); x += step) {
    for (float y = 0.0F; y <= size.y(); y += step) {
      cloud.emplace_back(x, y, 0.0F);
      cloud.emplace_back(x, y, size.z());
    }
    for (float z = 0.0F; z <= size.z(); z += step) {
      cloud.emplace_back(x, 0.0F, z);
      cloud.emplace_back(x, size.y(), z);
    }
  }
  for (float y = 0.0F; y <= size.y(); y += step) {
    for (float z = 0.0F; z <= size.z(); z += step) {
      cloud.emplace_back(0.0F, y, z);
      cloud.emplace_back(size.x(), y, z);
    }
  }
  return cloud;
}

TEST(MapJudge, OfAShipNothingIsSaidButThatHerCoamingsHaveNoTops) {
  EXPECT_THAT(judge_cloud(ship(), config()), IsEmpty());
  const auto findings = judge_map(*bulk_carrier_map());
  ASSERT_EQ(findings.size(), 1U);  // her hatches are walls alone
  EXPECT_THAT(told(findings, "hull.map"), HasSubstr("warning: no coaming's top was found in it"));
}

TEST(MapJudge, AnotherUnitIsRefusedAndNamed) {
  for (const float factor : {100.0F, 1000.0F}) {
    TrackerConfig in_that_unit = config();
    in_that_unit.hull.reference_point *= factor;
    EXPECT_THAT(told(judge_cloud(times(ship(), factor), in_that_unit), "hull.map"),
                AllOf(HasSubstr("refused: extends"), HasSubstr("along X, and no hull is longer than 500 m")));
  }
  EXPECT_THAT(told(judge_cloud(times(ship(), 100.0F), config()), "hull.map"),
              HasSubstr("; in centimetres it would be"));
}

TEST(MapJudge, TwoShipsFarApartAreNoHull) {
  Cloud two = ship();
  for (const Point& p : ship()) {
    two.push_back(p + Point(0.0F, 8000.0F, 0.0F));
  }
  EXPECT_THAT(told(judge_cloud(two, config()), "hull.map"), HasSubstr("m along Y, and no hull is longer"));
}

TEST(MapJudge, APieceOfAShipAndACubeAreWarnedOf) {
  TrackerConfig at_zero;
  EXPECT_THAT(told(judge_cloud(box({10.0F, 10.0F, 10.0F}, 0.1F), at_zero), "hull.map"),
              HasSubstr("warning: extends 10.00 m, and the smallest hull at a loader is 20 m long"));
  EXPECT_THAT(told(judge_cloud(box({30.0F, 30.0F, 30.0F}, 0.5F), at_zero), "hull.map"),
              HasSubstr("warning: extends 30.0 m along X and 30.0 m along Y"));
}

TEST(MapJudge, FewerPointsThanAScanMustMatchAreRefused) {
  EXPECT_THAT(told(judge_cloud(Cloud(199, Point::Zero()), {}), "hull.map"),
              HasSubstr("refused: has 199 points, fewer than health.min_matched = 200"));
}

TEST(MapJudge, TheReferenceIsNoFartherFromTheShipThanItsAttitudeAllows) {
  // 0.05 m at 0.1 deg: 28.65 m.
  const Cloud deck = box({40.0F, 10.0F, 0.0F}, 0.5F);
  for (const double z : {28.6, 28.7, 500.0}) {
    TrackerConfig above;
    above.hull.reference_point = {20.0, 5.0, z};
    const std::string words = told(judge_cloud(deck, above), "hull.reference_point");
    EXPECT_EQ(words.empty(), z < 28.65) << words;
    if (z > 100.0) {
      EXPECT_THAT(words,
                  AllOf(HasSubstr("refused: lies 500.0 m from the nearest point"), HasSubstr("0.87 m")));
    }
  }
}

TEST(MapJudge, AnEnvelopeHasRoomForTheErrorOfAPose) {
  TrackerConfig narrow = config();
  narrow.hull.envelope = Box{Point::Zero(), Point::Zero()};
  const auto findings = judge_cloud(ship(), narrow);
  for (const char* axis : {"X", "Y", "Z"}) {
    EXPECT_THAT(told(findings, "hull.envelope"),
                HasSubstr("refused: is 0.000 m wide along " + std::string(axis)));
  }
  narrow.hull.envelope = Box{{-1.0F, -0.06F, -1.0F}, {1.0F, 0.05F, 1.0F}};
  EXPECT_EQ(told(judge_cloud(ship(), narrow), "hull.envelope"), "");
}

TEST(MapJudge, AnEnvelopeWithoutTheMapsOwnPlaceIsWarnedOf) {
  TrackerConfig sunk = config();
  sunk.hull.envelope = Box{{-1.0F, -1.0F, -9.0F}, {1.0F, 1.0F, -0.5F}};
  EXPECT_THAT(told(judge_cloud(ship(), sunk), "hull.envelope"), HasSubstr("warning: leaves out 0, 0, 0"));
}

TEST(MapJudge, ARegionThatNoPoseBringsTheShipIntoIsRefused) {
  const Cloud deck = box({40.0F, 10.0F, 0.0F}, 0.5F);
  TrackerConfig with_region;  // envelope: 15 m along X, 2 m along Y, 10 m up and down
  with_region.hull.region = Box{{1000.0F, -100.0F, -100.0F}, {1100.0F, 100.0F, 100.0F}};
  EXPECT_THAT(told(judge_cloud(deck, with_region), "hull.region"),
              HasSubstr("refused: no point of the map can come nearer to it than 938.4 m"))
      << "1000 - 40 - 15 m, less what a turn moves a point 41 m from the reference by";
  with_region.hull.region = Box{{50.0F, -100.0F, -100.0F}, {1100.0F, 100.0F, 100.0F}};
  EXPECT_THAT(told(judge_cloud(deck, with_region), "hull.region"),
              HasSubstr("warning: holds no point of the map"));
  with_region.hull.region = Box{{30.0F, -100.0F, -100.0F}, {1100.0F, 100.0F, 100.0F}};
  EXPECT_EQ(told(judge_cloud(deck, with_region), "hull.region"), "");
}

TEST(MapJudge, EqualPointsAreRefused) {
  const HullMap map(Cloud(100'000, Point(1.0F, 2.0F, 3.0F)));
  EXPECT_THAT(told(judge_map(map), "hull.map"),
              HasSubstr("refused: all of its 100000 points lie in 1 cubes of 0.4 m, and 40 are the fewest"));
}

TEST(MapJudge, WhatHasNoSurfaceIsWarnedOf) {
  Cloud line;
  for (int i = 0; i < 10'000; ++i) {
    line.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
  }
  EXPECT_THAT(told(judge_map(HullMap(line)), "hull.map"),
              HasSubstr("warning: only 0 of its 250 surfaces are flat"));
  std::mt19937 random(1);
  std::uniform_real_distribution<float> at(0.0F, 30.0F);
  Cloud dust;
  for (int i = 0; i < 400; ++i) {
    dust.emplace_back(at(random), at(random), at(random));
  }
  EXPECT_THAT(told(judge_map(HullMap(dust)), "hull.map"),
              HasSubstr("warning: only 0 of its 400 surfaces are flat"));
}

TEST(MapJudge, WhatLeavesDirectionsFreeIsWarnedOf) {
  EXPECT_THAT(
      told(judge_map(HullMap(box({40.0F, 20.0F, 0.0F}, 0.1F))), "hull.map"),
      AllOf(
          HasSubstr("warning: its surfaces leave 3 of the six directions of a pose free (0 flat pieces face "
                    "along X, 0 along Y, "),
          HasSubstr("along Z, 0 aslant")));
  EXPECT_THAT(told(judge_map(HullMap(box({2.0F, 2.0F, 2.0F}, 0.05F))), "hull.map"),
              HasSubstr("3 of the six directions"))
      << "a cube so small that no turn is held";
}

TEST(MapJudge, AShipWithoutCoamingsIsWarnedOf) {
  EXPECT_THAT(told(judge_map(HullMap(box({34.0F, 20.0F, 10.0F}, 0.1F))), "hull.map"),
              HasSubstr("warning: no coaming's top was found in it"));
}

}  // namespace
}  // namespace hulltrack
