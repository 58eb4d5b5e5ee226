#include "core/quay/misplacement.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hulltrack {
namespace {

/// Of a level top of 30 x 20 m, seen `too_high` (m); of a wall along x too if `wall`.
std::vector<QuayObservation> observations(double too_high, bool wall) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(0.0, 1.0);
  std::vector<QuayObservation> all;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(30.0 * along(random), 20.0 * along(random), 0.0);
    all.push_back({p, Eigen::Vector3d::UnitZ(), too_high, SurfaceClass::horizontal, 0});
    if (wall) {
      all.push_back(
          {{p.x(), 20.0, 6.0 * along(random)}, Eigen::Vector3d::UnitY(), 0.0, SurfaceClass::longitudinal, 0});
    }
  }
  return all;
}

TEST(Misplacement, WhatIsNotHeldIsAllThatMovesNothingThatWasSeen) {
  for (const bool wall : {false, true}) {
    const std::vector<QuayObservation> all = observations(0.3, wall);
    const Misplacement seen = find_misplacement(all);
    EXPECT_NEAR(seen.about({15.0, 10.0, 0.0})[5], 0.3, 1e-3);
    const std::vector<Twist> unheld = seen.unheld();
    EXPECT_EQ(seen.measured.size(), wall ? 5U : 3U);
    EXPECT_EQ(seen.measured.size() + unheld.size(), Misplacement::kDirections);
    for (const Twist& twist : unheld) {
      for (const QuayObservation& o : all) {
        EXPECT_NEAR(o.n_W.dot(about_point(o.p_W - seen.centre_W, twist).tail<3>()), 0.0, 1e-6);
      }
    }
  }
  EXPECT_EQ(find_misplacement({}).unheld().size(), Misplacement::kDirections);
}

}  // namespace
}  // namespace hulltrack
