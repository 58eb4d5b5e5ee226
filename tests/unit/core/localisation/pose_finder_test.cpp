// Frames as the tracker has them, but the verdicts on poses are the test's: which poses are found, and which
// places are named beside them?
#include "core/localisation/pose_finder.hpp"

#include <gtest/gtest.h>

#include "tests/support/analytic_ship.hpp"

namespace hulltrack {
namespace {

using Eigen::Vector3d;
using testing::AnalyticShip;

const Vector3d kReference{3.0, -6.0, 1.4};
const Vector3d kBetweenHatches{23.0, 0.0, 0.0};  // the ship's two hatches are alike

Pose lying(const Vector3d& displacement) {
  return pose_about(kReference, Eigen::Matrix3d::Identity(), displacement);
}

PoseFinder finder_of(RegistrationMethod method = RegistrationMethod::automatic) {
  HullConfig hull;
  hull.reference_point = kReference;
  hull.envelope = {{-30.0F, -2.0F, -5.0F}, {30.0F, 2.0F, 5.0F}};
  RegistrationConfig registration;
  registration.method = method;
  return {hull, registration, *testing::bulk_carrier_map()};
}

/// The ship as a LiDAR sees it, without the quay: between x0 and x1 of the hull.
Cloud scan_of(const Pose& T_W_H, double x0 = -30.0, double x1 = 30.0) {
  static const AnalyticShip ship = AnalyticShip::bulk_carrier();
  const SensorConfig sensor = testing::looking_down({-1.0, -3.0, 17.0});
  Cloud hull_W;
  for (const LidarPoint& point : testing::scan_ship(&ship, sensor, {.T_W_H = T_W_H}).points) {
    const Vector3d p_W = sensor.mount * Vector3d(point.x, point.y, point.z);
    const Vector3d p_H = T_W_H.inverse() * p_W;
    if (p_H.x() > x0 && p_H.x() < x1 && std::abs(p_H.y()) < 10.5) {
      hull_W.push_back(p_W.cast<float>());
    }
  }
  return hull_W;
}

class Finding : public ::testing::Test {
 protected:
  /// A frame that finds no fault with its pose, nor with a rival if `rivals_fit`.
  Pose step(const Cloud& hull_W, bool rivals_fit = true) {
    const Pose T_H_W = finder.find(hull_W, time, track).icp.T_target_source;
    progress =
        finder.search(track, PoseFinder::Answer{T_H_W, false}, [&](const Pose&) { return !rivals_fit; });
    time += std::chrono::milliseconds(100);
    return T_H_W.inverse();
  }
  /// As many frames as a search needs, and some to examine places.
  Pose search(const Cloud& hull_W, bool rivals_fit = true) {
    Pose T_W_H;
    for (int i = 0; i < 8; ++i) {
      T_W_H = step(hull_W, rivals_fit);
    }
    return T_W_H;
  }
  void follow(const Vector3d& displacement) {
    track.unique = true;
    track.followed = FollowedPose{time, moved_hull(displacement, Eigen::Matrix3d::Identity(), kReference)};
  }
  static double error(const Pose& T_W_H, const Vector3d& displacement) {
    return (T_W_H * kReference - kReference - displacement).norm();
  }

  PoseFinder finder = finder_of();
  Track track;
  MeasurementTime time{};
  SearchProgress progress;
};

TEST_F(Finding, AHullAnywhereInTheBerthIsFound) {
  const Vector3d displacement{-12.0, 1.0, 2.0};
  const Cloud hull_W = scan_of(lying(displacement));
  (void)step(hull_W, false);
  EXPECT_LT(progress.tried, progress.starts) << "a search takes some frames";
  EXPECT_LT(error(search(hull_W, false), displacement), 0.03);
  EXPECT_EQ(progress.tried, progress.starts);
  EXPECT_FALSE(progress.rival);
}

TEST_F(Finding, OfTwoHatchesThatAreAlikeTheOtherIsNamedAsARival) {
  const Vector3d displacement{2.0, 0.0, 0.0};
  const Cloud hatch_W = scan_of(lying(displacement), 1.2, 19.5);
  const Pose T_W_H = search(hatch_W);
  const bool right = error(T_W_H, displacement) < 1.0;
  EXPECT_LT(error(T_W_H, right ? displacement : displacement + kBetweenHatches), 0.05);
  EXPECT_EQ(progress.tried, progress.starts);
  ASSERT_TRUE(progress.rival);
  EXPECT_LT((*progress.rival - (right ? displacement + kBetweenHatches : displacement)).norm(), 0.05);
}

TEST_F(Finding, ARivalThatTheScanContradictsIsNone) {
  (void)search(scan_of(lying({2.0, 0.0, 0.0}), 1.2, 19.5), false);
  EXPECT_EQ(progress.tried, progress.starts);
  EXPECT_FALSE(progress.rival);
}

TEST_F(Finding, AHullThatIsFollowedIsNotSearchedForAndKeepsItsPlaceBesideItsLike) {
  const Vector3d displacement{0.1, 0.0, 0.0};
  const Cloud hatch_W = scan_of(lying(displacement), 1.2, 19.5);
  for (int i = 0; i < 25; ++i) {
    follow({0.0, 0.0, 0.0});
    EXPECT_LT(error(step(hatch_W), displacement), 0.03) << i;
  }
}

TEST_F(Finding, AFalsePlaceDoesNotPersist) {
  const Cloud hull_W = scan_of(lying({0.0, 0.0, 0.0}));
  int frames = 0;
  Vector3d followed = lying(kBetweenHatches) * kReference - kReference;
  while (followed.norm() > 1.0 && frames < 40) {
    follow(followed);
    followed = step(hull_W) * kReference - kReference;
    ++frames;
  }
  EXPECT_LE(frames, 22) << "one stretch of twenty a frame";
}

TEST_F(Finding, ABetterPlaceThatTheScanContradictsNeverTakesTheFrame) {
  const Vector3d displacement{-12.0, 0.0, 0.0};
  const Cloud hull_W = scan_of(lying(displacement));
  const Vector3d elsewhere = displacement + kBetweenHatches;
  int examined = 0;
  for (int i = 0; i < 45; ++i) {
    follow(elsewhere);
    const Pose T_H_W = finder.find(hull_W, time, track).icp.T_target_source;
    EXPECT_GT(error(T_H_W.inverse(), displacement), 1.0) << i;
    (void)finder.search(track, PoseFinder::Answer{T_H_W, false}, [&](const Pose& rival) {
      EXPECT_LT(error(rival.inverse(), displacement), 0.1) << "aligned with all of the scan";
      ++examined;
      return true;
    });
    time += std::chrono::milliseconds(100);
  }
  EXPECT_GE(examined, 2) << "each time that its stretch of starts comes round";
}

TEST_F(Finding, AfterAReacquireEdgeTheBerthIsSearchedAnew) {
  const Cloud hull_W = scan_of(lying({-12.0, 1.0, 2.0}));
  (void)search(hull_W);
  ASSERT_EQ(progress.tried, progress.starts);
  ++track.searches;
  (void)step(hull_W);
  EXPECT_LT(progress.tried, progress.starts);
}

TEST_F(Finding, AHullUnseenForLongIsLookedForBeyondTheEnvelopeToo) {
  follow({0.0, 0.0, 0.0});
  (void)step(scan_of(lying({0.0, 0.0, 0.0})));
  const auto last = track.followed;
  track = {};
  track.last_unique = last;
  track.searches = 1;
  time += std::chrono::seconds(60);
  const Vector3d displacement{-34.0, 0.0, 0.0};  // the envelope ends at 30 m, a drift of a minute at 36 m
  EXPECT_LT(error(search(scan_of(lying(displacement))), displacement), 0.05);
}

TEST_F(Finding, AScanOfAFewPointsIsNoneToSearchWith) {
  Cloud few = scan_of(lying({0.0, 0.0, 0.0}));
  few.resize(50);
  for (int i = 0; i < 5; ++i) {
    (void)step(few);
    EXPECT_LT(progress.tried, progress.starts);
  }
}

TEST_F(Finding, ThePublishedMethodStartsFromThePlcAloneAndHasNoCovariance) {
  PoseFinder published = finder_of(RegistrationMethod::point_to_point);
  const Cloud hull_W = scan_of(lying({0.1, 0.0, 0.05}));
  const PlaneIcpResult fresh = published.find(hull_W, time, track);
  EXPECT_FALSE(fresh.covariance.valid);
  follow(kBetweenHatches);
  const PlaneIcpResult following = published.find(hull_W, time, track);
  EXPECT_EQ(fresh.icp.T_target_source.matrix(), following.icp.T_target_source.matrix());
}

}  // namespace
}  // namespace hulltrack
