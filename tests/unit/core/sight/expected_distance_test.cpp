// ExpectedDistance against a closed form: a wall that is scanned in lines kPitch apart.
//
// A point's distance from the nearest of them is spread evenly from 0 to kPitch / 2, so the quartile is an
// eighth of kPitch. The lines run askew over the wall, so that the map's voxels do not keep step with them.
#include "core/sight/expected_distance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "core/map/surfels.hpp"

namespace hulltrack {
namespace {

constexpr double kPitch = 0.6;  // m
constexpr double kHalf = 8.0;   // m, half of the wall's width and height
const Point kLidar{0.0F, 0.0F, 0.0F};

double with_noise(double between) { return std::hypot(between, ExpectedDistance::kRangeNoise); }

Cloud wall() {
  Cloud cloud;
  for (double y = -kHalf; y < kHalf; y += 0.1) {
    for (double z = -kHalf; z < kHalf; z += 0.1) {
      cloud.push_back(Eigen::Vector3d(20.0, y, z).cast<float>());
    }
  }
  return cloud;
}

class WallInLines : public testing::Test {
 protected:
  /// How far along its way from the LiDAR to the wall a ray comes back: 1 on the wall, 0 never.
  using End = std::function<float(const Point&)>;

  /// Returns of lines on the wall, the middle one `shift` off its centre, seen from `from`.
  [[nodiscard]] Cloud lines(const Point& from, double shift, const End& end) const {
    const Eigen::Rotation2Dd askew(0.5);
    Cloud returns;
    for (double v = shift - 20.0 * kPitch; v <= 20.0 * kPitch; v += kPitch) {
      for (double u = -1.5 * kHalf; u < 1.5 * kHalf; u += 0.03) {
        const Eigen::Vector2d yz = askew * Eigen::Vector2d(u, v);
        const Point met = (T_W_H * Eigen::Vector3d(20.0, yz.x(), yz.y())).cast<float>();
        if (const float way = end(met); way > 0.0F) {
          returns.push_back(from + way * (met - from));
        }
      }
    }
    return returns;
  }

  void add_lidar(
      const Point& at, double shift, const End& end = [](const Point&) { return 1.0F; }) {
    Pose T_W_L = Pose::Identity();
    T_W_L.translation() = at.cast<double>();
    views.emplace_back().rebuild(lines(at, shift, end), T_W_L);
  }

  /// As if the first LiDAR saw `count` points of the wall and no more.
  [[nodiscard]] std::optional<double> q1(std::size_t count = 100'000) {
    std::vector<VisiblePoint> visible;
    const Pose T_L_H = views.front().T_W_L().inverse() * T_W_H;
    for (std::uint32_t i = 0; i < map.subset_H().size() && i < count; ++i) {
      visible.push_back({i, 0, (T_L_H * map.subset_H()[i].cast<double>()).cast<float>()});
    }
    return expected_distance.q1(map, visible, T_W_H, views);
  }

  const HullMap map{wall()};
  Pose T_W_H = Pose::Identity();
  std::vector<ScanView> views;
  ExpectedDistance expected_distance;
};

constexpr double kTolerance = 0.1 * kPitch / 8.0;

TEST_F(WallInLines, ExpectsAnEighthOfTheLinesPitch) {
  add_lidar(kLidar, 0.0);
  ASSERT_TRUE(q1());
  EXPECT_NEAR(*q1(), with_noise(kPitch / 8.0), kTolerance);
}

TEST_F(WallInLines, MeasuresInThePlaneHoweverTheHullLies) {
  T_W_H = pose_from_xyz_rpy_deg({6.0, -14.0, 2.0}, {3.0, -5.0, 45.0});
  add_lidar({1.0F, 2.0F, 3.0F}, 0.0);
  ASSERT_TRUE(q1());
  EXPECT_NEAR(*q1(), with_noise(kPitch / 8.0), kTolerance);
}

TEST_F(WallInLines, CountsRaysWhereverTheyEnded) {
  int ray = 0;
  add_lidar(kLidar, 0.0, [&](const Point&) { return std::array{0.2F, 1.0F, 1.7F}[ray++ % 3]; });
  ASSERT_TRUE(q1());
  EXPECT_NEAR(*q1(), with_noise(kPitch / 8.0), kTolerance);
}

TEST_F(WallInLines, PutsPointsThatNoRayPassesBehindAllOthers) {
  add_lidar(kLidar, 0.0, [](const Point& met) { return met.y() < 0.0F ? 1.0F : 0.0F; });
  ASSERT_TRUE(q1());
  EXPECT_NEAR(*q1(), with_noise(kPitch / 4.0), 2.0 * kTolerance) << "the median of the half with rays";
  views.clear();
  add_lidar(kLidar, 0.0, [](const Point& met) { return met.y() < -5.0F ? 1.0F : 0.0F; });
  ASSERT_TRUE(q1());
  EXPECT_NEAR(*q1(), with_noise(kSurfelRadius), 1e-6) << "less than a quarter has rays: at least so much";
}

TEST_F(WallInLines, PromisesNoMoreThanHasBeenLookedAt) {
  // From 10 m the cells around are a degree wide, 0.175 m: no ray within them tells no more than that.
  constexpr double kDistance = 10.0;
  add_lidar(Eigen::Vector3d(20.0 - kDistance, 0.0, 0.0).cast<float>(), 0.0,
            [](const Point& met) { return met.y() < -5.0F ? 1.0F : 0.0F; });
  ASSERT_TRUE(q1());
  EXPECT_GT(*q1(), with_noise(kDistance * std::sin(radians(1.0)) - 1e-3));
  EXPECT_LT(*q1(), with_noise(kSurfelRadius));
}

TEST_F(WallInLines, ExpectsNothingOfAFewPoints) {
  add_lidar(kLidar, 0.0);
  EXPECT_FALSE(q1(ExpectedDistance::kFewest - 1));
  EXPECT_TRUE(expected_distance.had_few_surfels());
  EXPECT_TRUE(q1(4 * ExpectedDistance::kFewest)) << "some are at the wall's edge, where nothing is flat";
  EXPECT_FALSE(expected_distance.had_few_surfels());
}

TEST_F(WallInLines, ASecondLidarBetweenTheLinesHalvesItWhereItsSightIsFree) {
  add_lidar(kLidar, 0.0);
  add_lidar({2.0F, 3.0F, -1.0F}, kPitch / 2.0);
  ASSERT_TRUE(q1());
  EXPECT_NEAR(*q1(), with_noise(kPitch / 16.0), kTolerance);
  views.pop_back();
  add_lidar({2.0F, 3.0F, -1.0F}, kPitch / 2.0, [](const Point&) { return 0.5F; });
  ASSERT_TRUE(q1());
  EXPECT_NEAR(*q1(), with_noise(kPitch / 8.0), kTolerance) << "something hides the wall from it";
}

}  // namespace
}  // namespace hulltrack
