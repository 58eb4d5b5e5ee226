// Where could the hull lie? The answers are known because the scans are cast from a ship that was put there.
#include "core/localisation/hull_search.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/analytic_ship.hpp"

namespace hulltrack {
namespace {

using Eigen::Vector3d;
using testing::AnalyticShip;

const Vector3d kReference{3.0, -6.0, 1.4};
const Vector3d kLidar{-1.0, -3.0, 17.0};
const Box kBerth{{-15.0F, -2.0F, -10.0F}, {15.0F, 2.0F, 10.0F}};

/// The hull turned about its reference point and displaced: T_H_W.
Pose lying(const Vector3d& displacement, double yaw_deg = 0.0) {
  return pose_about(kReference, rotation_from_rpy({0.0, 0.0, radians(yaw_deg)}), displacement).inverse();
}

/// Some 500 returns of the ship, with 2 cm of noise, from a LiDAR that looks down, or `dense`^2 times as
/// many.
Cloud few_of_the_ship(const Pose& T_H_W, int dense = 1) {
  static const AnalyticShip ship = AnalyticShip::bulk_carrier();
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 0.02);
  const Vector3d lidar_H = T_H_W * kLidar;
  Cloud few_W;
  for (int i = -17 * dense; i <= 17 * dense; ++i) {
    for (int j = -11 * dense; j <= 11 * dense; ++j) {
      const Vector3d ray_W = Vector3d(0.1 * i / dense + 0.01, 0.09 * j / dense, -1.0).normalized();
      if (const auto range = ship.cast(lidar_H, T_H_W.linear() * ray_W)) {
        few_W.push_back((kLidar + (*range + noise(random)) * ray_W).cast<float>());
      }
    }
  }
  return few_W;
}

class HullSearchOfABerth : public ::testing::Test {
 protected:
  /// Begins and tries all starts.
  void search_for(std::span<const Point> few_W, const Box& reach = kBerth) {
    search.begin(few_W, reach, Eigen::Matrix3d::Identity());
    while (!search.complete()) {
      search.advance(few_W, 4, icp);
    }
  }
  double score(std::span<const Point> few_W, const Pose& T_H_W) { return search.score(few_W, T_H_W, icp); }

  /// Within what align() reaches.
  ::testing::AssertionResult is(const Pose& found, const Pose& T_H_W) const {
    const double off = search.distance(found, T_H_W);
    const double turned = rotation_angle(found.linear() * T_H_W.linear().transpose());
    if (off < 0.3 && turned < radians(1.0)) {
      return ::testing::AssertionSuccess();
    }
    return ::testing::AssertionFailure() << "off by " << off << " m and " << degrees(turned) << " deg";
  }
  std::size_t places_near(const Pose& T_H_W) const {
    std::size_t count = 0;
    for (const HullSearch::Place& place : search.places()) {
      count += search.distance(place.T_H_W, T_H_W) < HullSearch::kSamePlace ? 1 : 0;
    }
    return count;
  }

  PointToPlaneIcp icp{{}, {kReference.x(), 60.0}};
  HullSearch search{kReference, *testing::bulk_carrier_map()};
};

TEST_F(HullSearchOfABerth, DistanceIsThatOfTheReferencePoint) {
  EXPECT_NEAR(search.distance(lying({1, 2, 2}, 40.0), lying({0, 0, 0}, -10.0)), 3.0, 1e-12);
}

TEST_F(HullSearchOfABerth, FindsTheHullWhereverItLiesInTheEnvelope) {
  std::vector<Vector3d> displacements;
  for (const double x : {-15.0, 15.0}) {  // corners, then anywhere
    for (const double y : {-2.0, 2.0}) {
      displacements.emplace_back(x, y, -10.0);
      displacements.emplace_back(x, y, 9.0);  // the LiDAR is 6.6 m above the coamings
    }
  }
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 30; ++i) {
    displacements.emplace_back(15.0 * unit(random), 2.0 * unit(random), -1.0 + 9.0 * unit(random));
  }
  for (const Vector3d& displacement : displacements) {
    const Pose T_H_W = lying(displacement);
    const Cloud few_W = few_of_the_ship(T_H_W);
    search_for(few_W);
    ASSERT_FALSE(search.places().empty());
    const Pose& place = search.places().front().T_H_W;
    const PlaneIcpResult found =
        icp.align(few_of_the_ship(T_H_W, 3), testing::bulk_carrier_map()->planes(), place, {});
    EXPECT_LT(search.distance(found.icp.T_target_source, T_H_W), 0.03) << displacement.transpose();
  }
}

TEST_F(HullSearchOfABerth, FindsAHullThatIsTurnedByADegreeOrByTheLastKnownTurn) {
  for (const double yaw : {-1.0, 1.0}) {
    const Pose T_H_W = lying({4.0, -1.0, 1.0}, yaw);
    search_for(few_of_the_ship(T_H_W));
    EXPECT_TRUE(is(search.places().front().T_H_W, T_H_W)) << yaw;
  }
  const Pose T_H_W = lying({4.0, -1.0, 1.0}, 4.0);
  const Cloud few_W = few_of_the_ship(T_H_W);
  search.begin(few_W, kBerth, T_H_W.linear().transpose());
  search.advance(few_W, 100, icp);
  EXPECT_TRUE(is(search.places().front().T_H_W, T_H_W));
}

TEST_F(HullSearchOfABerth, PlacesAreApartBestFirstAndTheirScoresThoseOfTheirPoses) {
  const Cloud few_W = few_of_the_ship(lying({3.0, 0.5, -1.0}));
  search_for(few_W);
  const auto places = search.places();
  ASSERT_GT(places.size(), 1U);
  EXPECT_LE(places.size(), HullSearch::kMostPlaces);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_EQ(places[i].score, score(few_W, places[i].T_H_W));
    EXPECT_EQ(places_near(places[i].T_H_W), 1U);
    EXPECT_FALSE(places[i].contradicted);
    EXPECT_FALSE(places[i].explains) << "nobody has examined it";
    EXPECT_TRUE(i == 0 || places[i].score <= places[i - 1].score);
  }
}

TEST_F(HullSearchOfABerth, ScoreIsTheShareOfTheScanThatAPoseExplains) {
  const Pose T_H_W = lying({3.0, 0.5, -1.0});
  Cloud few_W = few_of_the_ship(T_H_W);
  std::erase_if(few_W, [](const Point& p) { return p.z() < -3.0F; });  // what lies in the holds
  const double all = score(few_W, T_H_W);
  EXPECT_GT(all, 0.8);
  EXPECT_LE(all, 1.0);
  const std::size_t count = few_W.size();
  for (std::size_t i = 0; i < count; ++i) {
    few_W.push_back(few_W[i] + 6.0F * Point::UnitZ());  // as many that no plane explains
  }
  EXPECT_NEAR(score(few_W, T_H_W), all / 2.0, 0.05);
  EXPECT_EQ(score({}, T_H_W), 0.0);
}

TEST_F(HullSearchOfABerth, EveryFrameScoresThePlacesAnew) {
  search_for(few_of_the_ship(lying({3.0, 0.5, -1.0})));
  const Pose moved = lying({-8.0, 0.0, 0.0});
  search_for(few_of_the_ship(lying({-8.0, 0.0, 0.0})));
  search.settle(lying({3.0, 0.5, -1.0}), lying({3.0, 0.5, -1.0}), false);
  const Cloud few_W = few_of_the_ship(lying({3.0, 0.5, -1.0}));
  search.advance(few_W, 0, icp);
  EXPECT_TRUE(is(search.places().front().T_H_W, lying({3.0, 0.5, -1.0}))) << "the newest scan's best";
  EXPECT_EQ(places_near(moved), 1U) << "still a place";
}

TEST_F(HullSearchOfABerth, ThePlcsOwnPoseIsTriedFirstThenTheBestShift) {
  const Cloud near_W = few_of_the_ship(lying({0.3, -0.2, 0.2}));
  search.begin(near_W, kBerth, Eigen::Matrix3d::Identity());
  EXPECT_EQ(search.tried(), 0U);
  EXPECT_TRUE(search.places().empty());
  search.advance(near_W, 1, icp);
  EXPECT_EQ(search.tried(), 1U);
  ASSERT_EQ(search.places().size(), 1U);
  EXPECT_TRUE(is(search.places().front().T_H_W, lying({0.3, -0.2, 0.2})));

  const Pose far = lying({-11.0, 1.5, 3.0});
  const Cloud far_W = few_of_the_ship(far);
  search.begin(far_W, kBerth, Eigen::Matrix3d::Identity());
  search.advance(far_W, 1, icp);
  EXPECT_EQ(places_near(far), 0U);
  search.advance(far_W, 1, icp);
  EXPECT_TRUE(is(search.places().front().T_H_W, far));
  EXPECT_FALSE(search.complete());
  search.advance(far_W, 100, icp);
  EXPECT_TRUE(search.complete());
  EXPECT_EQ(search.tried(), search.starts());
}

TEST_F(HullSearchOfABerth, LooksWithinItsReachOnly) {
  const Box reach{{4.0F, -1.0F, -1.0F}, {6.0F, 1.0F, 1.0F}};
  search_for(few_of_the_ship(lying({-11.0, 1.5, 3.0})), reach);
  for (const HullSearch::Place& place : search.places()) {
    const Vector3d displacement = place.T_H_W.inverse() * kReference - kReference;
    const Vector3d off = displacement - Vector3d(5.0, 0.0, 0.0);
    // An approach mends half a metre, and some more once it has begun to slide.
    EXPECT_TRUE(displacement.norm() < 1.0 || off.cwiseAbs().maxCoeff() < 2.0) << displacement.transpose();
  }
  search_for(few_of_the_ship(lying({5.3, -0.7, 0.4})), reach);
  EXPECT_TRUE(is(search.places().front().T_H_W, lying({5.3, -0.7, 0.4})));
}

/// A scan of nothing but one of the two hatches, which are alike, and the deck beside it.
TEST_F(HullSearchOfABerth, TwoHatchesThatAreAlikeGiveTwoPlacesThatExplainTheSame) {
  const double kApart = 23.0;  // m
  const Pose T_H_W = lying({2.0, 0.0, 0.0});
  Cloud few_W = few_of_the_ship(T_H_W);
  std::erase_if(few_W, [&](const Point& p) {
    const Vector3d p_H = T_H_W * p.cast<double>();
    return p_H.x() < 1.2 || p_H.x() > 19.5;
  });
  ASSERT_GT(few_W.size(), 100U);
  search_for(few_W, {{-10.0F, -2.0F, -5.0F}, {40.0F, 2.0F, 5.0F}});
  const auto places = search.places();
  ASSERT_GE(places.size(), 2U);
  EXPECT_EQ(places_near(T_H_W), 1U);
  EXPECT_EQ(places_near(lying({2.0 + kApart, 0.0, 0.0})), 1U);
  EXPECT_NEAR(places[0].score, places[1].score, 0.05 * places[0].score);
  EXPECT_NEAR(search.distance(places[0].T_H_W, places[1].T_H_W), kApart, 0.3);
}

TEST_F(HullSearchOfABerth, APlaceThatWasExaminedSaysWhatCameOfIt) {
  const Pose truth = lying({3.0, 0.5, -1.0});
  const Cloud few_W = few_of_the_ship(truth);
  search_for(few_W);
  const Pose start = search.places()[1].T_H_W;
  const Pose led_to = lying({-5.0, -1.9, 6.0});
  ASSERT_EQ(places_near(led_to), 0U);

  const auto place_at = [&](const Pose& T_H_W) {
    for (const HullSearch::Place& place : search.places()) {
      if (search.distance(place.T_H_W, T_H_W) < 1e-9) {
        return place;
      }
    }
    ADD_FAILURE() << "no such place";
    return HullSearch::Place{};
  };
  search.settle(start, led_to, true);
  EXPECT_EQ(places_near(start), 0U);
  EXPECT_TRUE(place_at(led_to).contradicted);
  EXPECT_FALSE(place_at(led_to).explains);

  search.settle(truth, truth, false);
  EXPECT_FALSE(place_at(truth).contradicted);
  EXPECT_TRUE(place_at(truth).explains);
  EXPECT_EQ(places_near(truth), 1U);

  search.advance(few_W, 4, icp);
  EXPECT_TRUE(place_at(truth).explains) << "what was found out stays";
  EXPECT_EQ(place_at(truth).score, score(few_W, truth));

  search.settle(truth, truth, true);
  EXPECT_TRUE(place_at(truth).contradicted) << "the newest word counts";
  search.begin(few_W, kBerth, Eigen::Matrix3d::Identity());
  EXPECT_TRUE(search.places().empty());
}

TEST_F(HullSearchOfABerth, AChallengeFindsABetterPlaceWithinFortyMetresAlongTheShip) {
  const Pose truth = lying({0.0, 0.0, 0.0});
  const Cloud few_W = few_of_the_ship(truth);
  for (const Vector3d& off : {Vector3d(23, 0, 0), Vector3d(-23, 0, 0), Vector3d(3, 0.5, 0),
                              Vector3d(-10, 1, 2), Vector3d(38, -1, -1), Vector3d(-38, 0, 4)}) {
    std::optional<Pose> found;
    for (int i = 0; i < 20 && !found; ++i) {
      found = search.challenge(few_W, lying(off), 1.05, icp);
      EXPECT_TRUE(!found || score(few_W, *found) > 1.05 * score(few_W, lying(off)));
      if (found && !is(*found, truth)) {
        found.reset();  // better, but not the best
      }
    }
    EXPECT_TRUE(found) << off.transpose();
  }
}

TEST_F(HullSearchOfABerth, NothingChallengesTheBestPlace) {
  for (const Vector3d& displacement : {Vector3d(0, 0, 0), Vector3d(-7, 1, -2), Vector3d(9, -1, 3)}) {
    const Pose truth = lying(displacement);
    const Cloud few_W = few_of_the_ship(truth);
    for (int i = 0; i < 20; ++i) {
      EXPECT_FALSE(search.challenge(few_W, truth, 1.05, icp)) << displacement.transpose() << ", " << i;
    }
  }
}

TEST_F(HullSearchOfABerth, AChallengerMustBeBetterByTheMargin) {
  const Pose wrong = lying({23.0, 0.0, 0.0});
  const Cloud few_W = few_of_the_ship(lying({0.0, 0.0, 0.0}));
  const double most = 1.0 / score(few_W, wrong);
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(search.challenge(few_W, wrong, most, icp)) << "no place explains more than all";
  }
}

}  // namespace
}  // namespace hulltrack
