#include "core/registration/point_to_plane_icp.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "core/filter/voxel_filter.hpp"
#include "tests/support/analytic_ship.hpp"

namespace hulltrack {
namespace {

using testing::AnalyticShip;

constexpr BendShape kShape{3.0, 60.0};
constexpr Bend kStraight{0.0, 0.0};
const Eigen::Vector3d kReference(3.0, -6.0, 1.4);  // of the hull, in H

const PlaneMap& planes() { return testing::bulk_carrier_map()->planes(); }

/// A thinned scan in W of the ship at T_W_H.
Cloud scan_of_ship(const Pose& T_W_H, double noise, unsigned seed) {
  static const AnalyticShip ship = AnalyticShip::bulk_carrier();
  const SensorConfig sensor = testing::looking_down({-1.0, -3.0, 17.0});
  const Scan scan = testing::scan_ship(&ship, sensor, {.T_W_H = T_W_H, .range_sigma = noise, .seed = seed});
  Cloud cloud_W;
  for (const LidarPoint& p : scan.points) {
    cloud_W.push_back((sensor.mount * Eigen::Vector3d(p.x, p.y, p.z)).cast<float>());
  }
  Cloud thinned_W;
  VoxelFilter(0.4).filter(cloud_W, thinned_W);
  return thinned_W;
}

/// T_W_H that moves and turns (rad) the reference point.
Pose hull_at(const Eigen::Vector3d& displacement, const Eigen::Vector3d& turn) {
  return pose_from_twist_about(kReference, (Twist() << turn, displacement).finished());
}

double position_error(const PlaneIcpResult& result, const Pose& T_W_H) {
  return (result.icp.T_target_source * (T_W_H * kReference) - kReference).norm();
}

double turn_error(const PlaneIcpResult& result, const Pose& T_W_H) {
  return rotation_angle(result.icp.T_target_source.linear() * T_W_H.linear());
}

std::vector<Pose> poses_to_find() {
  std::vector<Pose> poses;
  for (const double side : {-1.0, 1.0}) {
    poses.push_back(hull_at({0.3 * side, 0, 0}, {0, 0, 0}));
    poses.push_back(hull_at({0, 0.3 * side, 0}, {0, 0, 0}));
    poses.push_back(hull_at({0, 0, 0.3 * side}, {0, 0, 0}));
    poses.push_back(hull_at({0, 0, 0}, {0, 0, radians(1.0) * side}));
    poses.push_back(hull_at({0, 0, 0}, {radians(1.0) * side, 0, 0}));
    poses.push_back(hull_at({0.17 * side, -0.17, 0.17}, {radians(0.6), radians(0.5), -radians(0.6) * side}));
  }
  return poses;
}

TEST(PointToPlaneIcp, FindsTheShipToMillimetresFromThreeDecimetresAndADegree) {
  PointToPlaneIcp icp({}, kShape);
  unsigned seed = 0;
  for (const Pose& T_W_H : poses_to_find()) {
    for (const double noise : {0.0, 0.02}) {
      const Cloud source = scan_of_ship(T_W_H, noise, ++seed);
      const PlaneIcpResult result = icp.align(source, planes(), Pose::Identity(), kStraight);
      EXPECT_TRUE(result.icp.converged);
      EXPECT_EQ(result.icp.stop, IcpStop::converged);
      EXPECT_EQ(result.icp.free_directions, 0);
      EXPECT_LT(position_error(result, T_W_H), noise == 0.0 ? 0.003 : 0.006) << seed;
      EXPECT_LT(turn_error(result, T_W_H), radians(0.03)) << seed;
    }
  }
}

TEST(PointToPlaneIcp, ErrorsAreThoseThatItsCovarianceClaims) {
  PointToPlaneIcp icp({}, kShape);
  double squares = 0.0;  // of the errors in units of what is claimed: chi^2 of 6 a scan
  constexpr int kScans = 40;
  for (unsigned seed = 0; seed < kScans; ++seed) {
    const Pose T_W_H = hull_at({0.01 * seed - 0.2, 0.1, -0.05}, {0, 0, radians(0.2)});
    const PlaneIcpResult result =
        icp.align(scan_of_ship(T_W_H, 0.02, seed), planes(), T_W_H.inverse(), kStraight);
    ASSERT_TRUE(result.covariance.valid);
    const Pose off = result.icp.T_target_source * T_W_H;
    Twist error;
    error << so3_log(off.linear()), off * result.icp.centre - result.icp.centre;
    const Matrix6 claimed = std::max(1.0, result.covariance.shared) * result.covariance.pose;
    squares += error.dot(claimed.inverse() * error) / kScans;
  }
  // The map's own noise and its planes' errors at edges come on top of the scan's.
  EXPECT_GT(squares, 2.0);
  EXPECT_LT(squares, 18.0);
}

TEST(PointToPlaneIcp, AsManyPointsOfSomethingElseAsOfTheShipDoNotPullIt) {
  PointToPlaneIcp icp({}, kShape);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  for (const Pose& T_W_H : poses_to_find()) {
    Cloud source = scan_of_ship(T_W_H, 0.02, 7);
    const std::size_t of_ship = source.size();
    while (source.size() < 2 * of_ship) {  // near surfaces of the ship, where they may pull
      source.push_back(source[source.size() % of_ship] +
                       0.5F * Point(unit(random), unit(random), unit(random)));
    }
    const PlaneIcpResult result = icp.align(source, planes(), Pose::Identity(), kStraight);
    EXPECT_TRUE(result.icp.converged);
    EXPECT_LT(position_error(result, T_W_H), 0.015);
    EXPECT_LT(turn_error(result, T_W_H), radians(0.08));
  }
}

TEST(PointToPlaneIcp, SameCallsGiveTheSameBitsWhateverWasAlignedBefore) {
  const Cloud source = scan_of_ship(hull_at({0.2, -0.1, 0.1}, {0, 0, 0.01}), 0.02, 1);
  PointToPlaneIcp fresh({}, kShape);
  PointToPlaneIcp used({}, kShape);
  (void)used.align(scan_of_ship(Pose::Identity(), 0.02, 2), planes(), Pose::Identity(), {0.0, 0.1});
  const PlaneIcpResult a = fresh.align(source, planes(), Pose::Identity(), {0.01, 0.06});
  const PlaneIcpResult b = used.align(source, planes(), Pose::Identity(), {0.01, 0.06});
  EXPECT_EQ(a.icp.T_target_source.matrix(), b.icp.T_target_source.matrix());
  EXPECT_EQ(a.bend, b.bend);
  EXPECT_EQ(a.covariance.pose, b.covariance.pose);
  EXPECT_EQ(a.covariance.shared, b.covariance.shared);
  EXPECT_EQ(a.icp.matched, b.icp.matched);
}

TEST(PointToPlaneIcp, NothingToMatchIsAStateAndLeavesTheStart) {
  PointToPlaneIcp icp({}, kShape);
  const Pose start = hull_at({0.1, 0.2, 0.3}, {0, 0, 0.01});
  for (const Cloud& source : {Cloud{}, Cloud(300, Point(0.0F, 0.0F, 100.0F))}) {
    const PlaneIcpResult result = icp.align(source, planes(), start, kStraight);
    EXPECT_FALSE(result.icp.converged);
    EXPECT_EQ(result.icp.stop, IcpStop::too_few_matches);
    EXPECT_EQ(result.icp.T_target_source.matrix(), start.matrix());
    EXPECT_EQ(result.icp.matched, 0u);
    EXPECT_FALSE(result.covariance.valid);
  }
}

TEST(PointToPlaneIcp, PointsThatAreNotFiniteAreAsIfTheyWereNot) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  PointToPlaneIcp icp({}, kShape);
  const Cloud source = scan_of_ship(hull_at({0.2, -0.1, 0.1}, {0, 0, 0.01}), 0.02, 1);
  Cloud soiled = source;
  for (const Point& p : {Point(kNan, 0, 0), Point(0, kNan, 0), Point(0, 0, -kInfinity)}) {
    soiled.insert(soiled.begin() + 10, p);
    soiled.push_back(p);
  }
  const PlaneIcpResult clean = icp.align(source, planes(), Pose::Identity(), kStraight);
  const PlaneIcpResult result = icp.align(soiled, planes(), Pose::Identity(), kStraight);
  EXPECT_TRUE(result.icp.converged);
  EXPECT_TRUE(result.icp.T_target_source.isApprox(clean.icp.T_target_source, 1e-12));
  EXPECT_EQ(result.icp.matched, clean.icp.matched);
  const Cloud none(500, Point::Constant(kNan));
  EXPECT_EQ(icp.align(none, planes(), Pose::Identity(), kStraight).icp.stop, IcpStop::too_few_matches);
}

TEST(PointToPlaneIcp, AStartThatIsNotFiniteIsRefused) {
  PointToPlaneIcp icp({}, kShape);
  Pose start = Pose::Identity();
  start.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const PlaneIcpResult result =
      icp.align(scan_of_ship(Pose::Identity(), 0.02, 1), planes(), start, kStraight);
  EXPECT_EQ(result.icp.stop, IcpStop::invalid_start);
  EXPECT_TRUE(result.icp.T_target_source.matrix().allFinite());
}

/// A lone level deck, one point a square of `spacing`, from -half to half.
Cloud deck(double half, double spacing, double noise) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, noise);
  Cloud cloud;
  for (double x = -half + spacing / 2; x < half; x += spacing) {
    for (double y = -half + spacing / 2; y < half; y += spacing) {
      cloud.push_back(Eigen::Vector3d(x, y, normal(random)).cast<float>());
    }
  }
  return cloud;
}

TEST(PointToPlaneIcp, OverALoneDeckNothingMovesAlongIt) {
  const Cloud map = deck(12.0, 0.07, 0.0);
  const PlaneMap lone(map, KdTree(map), Relief(map));
  PointToPlaneIcp icp({}, kShape);
  const Pose start = pose_from_xyz_rpy_deg({0.3, -0.2, 0.15}, {0.4, -0.3, 0.7});
  const PlaneIcpResult result = icp.align(deck(8.0, 0.37, 0.01), lone, start, kStraight);
  EXPECT_EQ(result.icp.free_directions, 3);
  EXPECT_FALSE(result.covariance.valid);
  const Eigen::Vector3d middle = result.icp.T_target_source * Eigen::Vector3d::Zero();
  const Eigen::Vector3d up = result.icp.T_target_source.linear() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(middle.z(), 0.0, 0.002);
  EXPECT_LT((up - Eigen::Vector3d::UnitZ()).norm(), radians(0.02));
  // What is left along the deck is what undoing the tilt of half a degree moves: tilt * height, and tilt^2.
  EXPECT_NEAR(middle.x(), 0.3, 0.005);
  EXPECT_NEAR(middle.y(), -0.2, 0.005);
  EXPECT_NEAR(rpy_from_rotation(result.icp.T_target_source.linear()).z(), radians(0.7), radians(0.01));
}

/// Every 40th point of the map's cloud, on a hull bent by d.
Cloud bent_ship(double d) {
  const Cloud& map = testing::bulk_carrier_map()->cloud_H();
  Cloud cloud;
  for (std::size_t i = 0; i < map.size(); i += 149) {
    cloud.push_back(map[i] + static_cast<float>(d * kShape.rise(map[i].x())) * Point::UnitZ());
  }
  return cloud;
}

TEST(PointToPlaneIcp, ABendThatIsNotKnownIsFoundAndThePoseStaysAtTheReferencePoint) {
  PointToPlaneIcp icp({}, kShape);
  for (const double d : {-0.05, 0.02, 0.05}) {
    const PlaneIcpResult result = icp.align(bent_ship(d), planes(), Pose::Identity(), {0.0, 0.06});
    EXPECT_TRUE(result.icp.converged) << d;
    EXPECT_NEAR(result.bend, d, 0.003) << d;
    EXPECT_NEAR(result.bend + result.covariance.bend_off, d, 0.003) << d;
    EXPECT_GT(result.covariance.bend_sigma, 0.0);
    EXPECT_LT(result.covariance.bend_sigma, 0.005);
    EXPECT_LT(position_error(result, Pose::Identity()), 0.003) << d;
  }
}

TEST(PointToPlaneIcp, ABendThatIsKnownStays) {
  PointToPlaneIcp icp({}, kShape);
  const PlaneIcpResult known = icp.align(bent_ship(0.05), planes(), Pose::Identity(), {0.05, 0.0});
  EXPECT_EQ(known.bend, 0.05);
  EXPECT_LT(position_error(known, Pose::Identity()), 0.003);
  EXPECT_NEAR(known.covariance.bend_off, 0.0, 0.003);
}

TEST(PointToPlaneIcp, ApproachOfNothingOrFromNowhereStays) {
  PointToPlaneIcp icp({}, kShape);
  const Pose start = hull_at({0.1, 0.2, 0.3}, {0, 0, 0.01});
  EXPECT_EQ(icp.approach({}, planes(), start).matrix(), start.matrix());
  const Pose far = hull_at({0, 0, 500.0}, {0, 0, 0});
  const Cloud source = scan_of_ship(Pose::Identity(), 0.02, 1);
  EXPECT_EQ(icp.approach(source, planes(), far).matrix(), far.matrix());
}

TEST(PointToPlaneIcp, ScoreIsHighestAtTheTruthAndNoMoreThanItsPoints) {
  PointToPlaneIcp icp({}, kShape);
  const Pose T_W_H = hull_at({2.0, 0.5, -1.0}, {0, 0, 0.01});
  const Cloud source = scan_of_ship(T_W_H, 0.02, 1);
  const PlaneScore truth = icp.score(source, planes(), T_W_H.inverse());
  EXPECT_EQ(truth.points, source.size());
  EXPECT_LE(truth.sum, truth.points);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double shift : {-1.0, -0.3, 0.3, 1.0}) {
      const Pose off = Eigen::Translation3d(shift * Eigen::Vector3d::Unit(axis)) * T_W_H;
      EXPECT_LT(icp.score(source, planes(), off.inverse()).sum, 0.97 * truth.sum) << axis << ": " << shift;
    }
  }
  EXPECT_EQ(icp.score({}, planes(), Pose::Identity()).points, 0u);
}

}  // namespace
}  // namespace hulltrack
