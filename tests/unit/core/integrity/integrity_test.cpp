// observe_pose() and Integrity against scenes written by hand: a corner of three walls, one ray to every
// surfel.
//
// The sensor stands at the world's origin and L is W. No ray casting, no visibility, no tracker: a ray ends
// where the test says, so that every answer follows from the definition.
#include "core/integrity/integrity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace hulltrack {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Squares of 4 x 4 m, 5 cm apart, whose normals are X, Y and Z, off the origin by 8, 7 and 6 m.
Cloud corner() {
  Cloud cloud;
  for (float a = -2.0F; a < 2.0F; a += 0.05F) {
    for (float b = -2.0F; b < 2.0F; b += 0.05F) {
      cloud.push_back({8.0F, a, b});
      cloud.push_back({a, 7.0F, b});
      cloud.push_back({a, b, -6.0F});
    }
  }
  return cloud;
}

class IntegrityRun : public testing::Test {
 protected:
  explicit IntegrityRun(Cloud cloud = corner()) : map(std::move(cloud)) {}

  /// Where the ray to a surfel ends: its place times the factor; nothing for 0.
  using Ray = std::function<float(const Surfel&, const Point&)>;

  /// Every surfel is asked for at the pose T_W_H; the rays go to where the corner stands in truth, at I.
  IntegrityReport look(const Ray& ray, const Pose& T_W_H = Pose::Identity()) {
    Cloud returns;
    std::vector<VisiblePoint> visible;
    for (std::uint32_t i = 0; i < map.subset_H().size(); ++i) {
      const Point& p = map.subset_H()[i];
      if (const float factor = ray(map.surfels()[i], p); factor != 0.0F) {
        returns.push_back(factor * p);
      }
      visible.push_back({i, 0, (T_W_H * p.cast<double>()).cast<float>()});
    }
    std::vector<ScanView> views(1);
    views[0].rebuild(returns, Pose::Identity());
    seen = observe_pose(map, visible, T_W_H, views);
    return {seen.counts, solve_plane_step(seen.surfels, reference), {}};
  }

  [[nodiscard]] std::uint32_t planar(SurfaceClass surface) const {
    const auto& all = map.surfels();
    return static_cast<std::uint32_t>(std::count_if(
        all.begin(), all.end(), [&](const Surfel& s) { return s.planar && s.surface == surface; }));
  }
  static const SurfaceCount& count(const IntegrityReport& report, SurfaceClass surface) {
    return report.surfaces[static_cast<std::size_t>(surface)];
  }

  Integrity integrity;
  PoseObservations seen;  // of the last look()
  const HullMap map;
  const Eigen::Vector3d reference{3.0, 3.0, -3.0};
};

constexpr SurfaceClass kClasses[] = {SurfaceClass::transverse, SurfaceClass::longitudinal,
                                     SurfaceClass::horizontal};

TEST_F(IntegrityRun, AScanThatFitsConfirmsEverySurfelAndAsksForNoStep) {
  const IntegrityReport report = look([](const Surfel&, const Point&) { return 1.0F; });
  for (const SurfaceClass surface : kClasses) {
    ASSERT_GT(planar(surface), 40U) << "the scene has surfels to judge by";
    EXPECT_EQ(count(report, surface).expected, planar(surface));
    EXPECT_EQ(count(report, surface).confirmed, planar(surface));
  }
  EXPECT_EQ(report.expected, report.confirmed);
  EXPECT_EQ(report.seen_through, 0U);
  ASSERT_TRUE(report.step.solved);
  EXPECT_LT(report.step.translation.norm(), 1e-4);
  EXPECT_LT(report.step.rotation.norm(), 1e-5);
}

TEST_F(IntegrityRun, APoseThatIsOffIsAskedForTheStepBack) {
  Pose T_W_H = Pose::Identity();
  T_W_H.translation() = Eigen::Vector3d(0.06, -0.04, 0.03);
  const IntegrityReport report = look([](const Surfel&, const Point&) { return 1.0F; }, T_W_H);
  EXPECT_EQ(report.expected, report.confirmed);
  ASSERT_TRUE(report.step.solved);
  EXPECT_LT((report.step.translation + T_W_H.translation()).norm(), 2e-3);
}

TEST_F(IntegrityRun, AWallThatIsNotThereIsSeenThroughAndOnlyItsClassIsMissed) {
  const IntegrityReport report = look([](const Surfel& surfel, const Point&) {
    return surfel.surface == SurfaceClass::transverse ? 1.5F : 1.0F;  // ends 4 m behind the wall
  });
  EXPECT_EQ(count(report, SurfaceClass::transverse).expected, planar(SurfaceClass::transverse));
  EXPECT_EQ(count(report, SurfaceClass::transverse).confirmed, 0U);
  EXPECT_EQ(count(report, SurfaceClass::longitudinal).confirmed, planar(SurfaceClass::longitudinal));
  EXPECT_EQ(count(report, SurfaceClass::horizontal).confirmed, planar(SurfaceClass::horizontal));
  EXPECT_EQ(report.seen_through, planar(SurfaceClass::transverse));
  EXPECT_FALSE(report.step.solved) << "nothing near the wall's plane tells where it is";
  EXPECT_NE(judge_integrity(report).faults, 0);
}

TEST_F(IntegrityRun, AWallThatStandsElsewhereIsContradictedButNotSeenThrough) {
  const IntegrityReport report = look([](const Surfel& surfel, const Point&) {
    return surfel.surface == SurfaceClass::longitudinal ? 7.3F / 7.0F : 1.0F;  // 0.3 m farther away
  });
  EXPECT_EQ(count(report, SurfaceClass::longitudinal).expected, planar(SurfaceClass::longitudinal));
  EXPECT_EQ(count(report, SurfaceClass::longitudinal).confirmed, 0U);
  EXPECT_EQ(report.seen_through, 0U);
}

TEST_F(IntegrityRun, WhatIsHiddenSaysNothing) {
  const IntegrityReport report = look([](const Surfel& surfel, const Point&) {
    return surfel.surface == SurfaceClass::horizontal ? 0.5F : 1.0F;  // something 3 m in front of the deck
  });
  EXPECT_EQ(count(report, SurfaceClass::horizontal).expected, 0U);
  EXPECT_EQ(report.seen_through, 0U);
  EXPECT_EQ(report.expected, report.confirmed);
}

TEST_F(IntegrityRun, AWallThatStandsNearerIsContradicted) {
  const IntegrityReport report = look([](const Surfel& surfel, const Point&) {
    return surfel.surface == SurfaceClass::longitudinal ? 6.7F / 7.0F : 1.0F;  // by 0.3 m
  });
  EXPECT_EQ(count(report, SurfaceClass::longitudinal).expected, planar(SurfaceClass::longitudinal));
  EXPECT_EQ(count(report, SurfaceClass::longitudinal).confirmed, 0U);
}

/// A deck 5.8 m below the sensor and the ship's side under its far edge.
Cloud deck_and_side() {
  Cloud cloud;
  for (float x = -3.0F; x < 3.0F; x += 0.05F) {
    for (float y = -2.0F; y < 4.0F; y += 0.05F) {
      cloud.push_back({x, y, -5.8F});
    }
    for (float z = -8.8F; z < -5.8F; z += 0.05F) {
      cloud.push_back({x, 4.0F, z});
    }
  }
  return cloud;
}

class IntegrityOverADeck : public IntegrityRun {
 protected:
  IntegrityOverADeck() : IntegrityRun(deck_and_side()) {}
};

TEST_F(IntegrityOverADeck, WhatTheShipItselfHidesSaysNothingHoweverLittleBelowItLies) {
  const IntegrityReport report = look([](const Surfel&, const Point& p) { return 5.8F / -p.z(); });
  ASSERT_GT(planar(SurfaceClass::longitudinal), 40U);
  EXPECT_EQ(count(report, SurfaceClass::longitudinal).expected, 0U);
  EXPECT_EQ(count(report, SurfaceClass::horizontal).confirmed, planar(SurfaceClass::horizontal));
  EXPECT_EQ(report.expected, report.confirmed);
}

TEST_F(IntegrityRun, LandmarksStandWhereTheBendPutsThem) {
  // The reference point is 1 km away, so that a metre of bend lifts all of the corner by a metre.
  const BendShape shape{1000.0, 2000.0};
  const auto displaced = [&](double bend) {
    integrity.forget();
    IntegrityReport report;
    for (int frame = 0; frame < 10; ++frame) {
      report = look([](const Surfel& surfel, const Point& p) {
        return surfel.surface == SurfaceClass::horizontal ? (p.z() + 0.1F) / p.z() : 1.0F;  // 0.1 m higher
      });
      report.step = {.solved = true};
      report.landmarks = integrity.weigh(map, MeasurementTime{}, {Pose::Identity(), reference}, shape, bend,
                                         seen, report.step);
    }
    EXPECT_GT(report.landmarks.in_view, 2U);
    return report.landmarks.displaced;
  };
  EXPECT_EQ(displaced(0.1), 0U);
  EXPECT_GT(displaced(0.0), 0U);
  EXPECT_GT(displaced(-0.1), 0U);
}

TEST_F(IntegrityRun, WhatWasSeenAtAPlaceFromWhichNoShipComesIsForgotten) {
  MeasurementTime time{};
  const auto displaced = [&](double x, double seconds, float factor) {
    IntegrityReport report;
    for (int frame = 0; frame < 3; ++frame) {
      report = look([&](const Surfel& surfel, const Point&) {
        return surfel.surface == SurfaceClass::horizontal ? factor : 1.0F;
      });
      report.step = {.solved = true};
      time += std::chrono::milliseconds(static_cast<int>(1e3 * seconds));
      report.landmarks = integrity.weigh(map, time, {Pose(Eigen::Translation3d(x, 0.0, 0.0)), reference},
                                         {1e3, 2e3}, 0.0, seen, report.step);
      seconds = 0.1;
    }
    return report.landmarks.displaced;
  };
  constexpr float kLower = 1.02F;  // of 6 m: 0.12 m
  const std::uint32_t there = displaced(0.0, 0.1, kLower);
  ASSERT_GT(there, 0U);
  EXPECT_EQ(displaced(0.0, 0.1, kLower), there);
  EXPECT_EQ(displaced(22.0, 0.1, 1.0F), 0U) << "one hatch off within a frame, where all fits";
  ASSERT_EQ(displaced(0.0, 0.1, kLower), there);
  EXPECT_EQ(displaced(0.3, 60.0, 1.0F), 0U) << "unseen for a minute, and elsewhere since";
  ASSERT_EQ(displaced(0.0, 0.1, kLower), there);
  EXPECT_EQ(displaced(0.0, 100.0, 1.0F), there) << "unseen for minutes, and where she was: the same ship";
  EXPECT_EQ(displaced(0.0, 400.0, 1.0F), 0U) << "time enough for another one to moor there";
}

TEST_F(IntegrityRun, WhereNoRayEndsNothingIsExpected) {
  const IntegrityReport report = look([](const Surfel&, const Point&) { return 0.0F; });
  EXPECT_EQ(report.expected, 0U);
  EXPECT_FALSE(report.step.solved);
  EXPECT_NE(judge_integrity(report).faults, 0) << "an empty scan is never healthy";
}

TEST_F(IntegrityRun, ReturnsThatAreNoNumbersConfirmNothing) {
  for (const float nonsense : {kNan, std::numeric_limits<float>::infinity()}) {
    const IntegrityReport report = look([=](const Surfel&, const Point&) { return nonsense; });
    EXPECT_EQ(report.confirmed, 0U);
    EXPECT_NE(judge_integrity(report).faults, 0);
  }
}

TEST_F(IntegrityRun, APoseThatIsNoNumberIsNeverHealthy) {
  Pose T_W_H = Pose::Identity();
  T_W_H.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const IntegrityReport report = look([](const Surfel&, const Point&) { return 1.0F; }, T_W_H);
  EXPECT_EQ(report.confirmed, 0U);
  EXPECT_NE(judge_integrity(report).faults, 0);
}

}  // namespace
}  // namespace hulltrack
