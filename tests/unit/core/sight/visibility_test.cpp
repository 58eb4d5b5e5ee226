#include "core/sight/visibility.hpp"

#include <gtest/gtest.h>

#include <map>

#include <map>
#include <random>

#include "core/geometry/sighting.hpp"
#include "tests/support/analytic_ship.hpp"

namespace hulltrack {
namespace {

using testing::AnalyticShip;

TEST(FastAtan2, IsWithinAFewMicroradians) {
  for (int i = 0; i < 100'000; ++i) {
    const double angle = -3.14159 + 6.28318 * i / 100'000;
    const auto x = static_cast<float>(7.0 * std::cos(angle));
    const auto y = static_cast<float>(7.0 * std::sin(angle));
    ASSERT_NEAR(fast_atan2(y, x), std::atan2(y, x), 2e-5) << angle;
  }
  EXPECT_EQ(fast_atan2(0.0F, 0.0F), 0.0F);
}

TEST(Sightings, EqualThePointsOneByOne) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> u(-40.0F, 40.0F);
  Cloud cloud(1000);  // the last block is not full
  for (Point& p : cloud) {
    p = Point(u(rng), u(rng), u(rng));
  }
  cloud[7] = Point::Zero();
  cloud[8] = Point(0.0F, 0.0F, -3.0F);
  std::size_t next = 0;
  sight(cloud, Pose::Identity(), [&](std::size_t at, const Sightings& seen, std::size_t i) {
    ASSERT_EQ(at, next++);
    EXPECT_EQ(seen.point(i), cloud[at]);
    EXPECT_EQ(seen.cell[i], SphericalGrid::cell(cloud[at]).index());
    EXPECT_FLOAT_EQ(seen.range2[i], cloud[at].squaredNorm());
  });
  EXPECT_EQ(next, cloud.size());

  const Pose T_L_W = pose_from_xyz_rpy_deg({1.0, -2.0, 3.0}, {10.0, 20.0, -130.0});
  sight(cloud, T_L_W, [&](std::size_t at, const Sightings& seen, std::size_t i) {
    EXPECT_LT((seen.point(i).cast<double>() - T_L_W * cloud[at].cast<double>()).norm(), 2e-5);
  });
}

TEST(SphericalGrid, NeighboursWrapAroundAndStopAtThePoles) {
  EXPECT_EQ((SphericalGrid::Cell{10, 359}.moved(0, 1).column), 0);
  EXPECT_EQ((SphericalGrid::Cell{10, 0}.moved(0, -1).column), 359);
  EXPECT_EQ((SphericalGrid::Cell{0, 5}.moved(-1, 0).row), 0);
  EXPECT_EQ((SphericalGrid::Cell{179, 5}.moved(1, 0).row), 179);
}

struct Sight {
  AnalyticShip ship = AnalyticShip::bulk_carrier();
  HullMap map{ship.map(0.1, 1)};
  SensorConfig sensor = testing::looking_down({-1.0, -3.0, 17.0});
  ScanFilter filter{{}, {sensor}, std::nullopt};
  FilteredScan filtered;
  std::vector<ScanView> views = std::vector<ScanView>(1);
  std::vector<VisiblePoint> visible;

  void look(const AnalyticShip* scanned) {
    filter.run(testing::scan_ship(scanned, sensor, {}), testing::joints_at_rest(1.0), {}, filtered);
    views[0].rebuild(filtered.returns_W[0], sensor.mount);
    Visibility(25.0).run(map, map.subset_H(), Pose::Identity(), views, std::vector{sensor}, visible);
  }

  /// Whether a point of the map is the first thing on its own ray, to `tolerance`.
  bool truly_in_sight(const Point& p_H, double tolerance) const {
    const Eigen::Vector3d o = sensor.mount.translation();
    const Eigen::Vector3d d = p_H.cast<double>() - o;
    const auto hit = ship.cast(o, d.normalized());
    return hit && *hit > d.norm() - tolerance;
  }
};

TEST(Visibility, VisiblePointsAreInSightByRayCasting) {
  Sight sight;
  sight.look(&sight.ship);
  ASSERT_GT(sight.visible.size(), 1000u);
  std::size_t hidden = 0;
  for (const VisiblePoint& v : sight.visible) {
    EXPECT_LE(v.p_L.norm(), 25.0F);
    hidden += sight.truly_in_sight(sight.map.subset_H()[v.index], 0.5) ? 0 : 1;
  }
  EXPECT_LT(hidden, sight.visible.size() / 50) << "behind something by more than the tolerance";
}

/// Nearest range in each cell of one degree, by the library's own trigonometry.
class RangeImage {
 public:
  void add(const Point& p_L) {
    float& nearest = cells_.try_emplace(cell(p_L), 1e9F).first->second;
    nearest = std::min(nearest, p_L.norm());
  }
  [[nodiscard]] float nearest(const Point& p_L) const {
    const auto found = cells_.find(cell(p_L));
    return found == cells_.end() ? 1e9F : found->second;
  }

 private:
  static std::pair<int, int> cell(const Point& p) {
    return {static_cast<int>(std::floor(degrees(std::asin(p.z() / p.norm())))),
            static_cast<int>(std::floor(degrees(std::atan2(p.y(), p.x()))))};
  }
  std::map<std::pair<int, int>, float> cells_;
};

TEST(Visibility, AgreesWithTheDefinitionOverTheWholeMap) {
  Sight sight;
  sight.look(&sight.ship);
  const Eigen::Isometry3f T_L_W = sight.sensor.mount.inverse().cast<float>();
  RangeImage map_image;
  RangeImage scan_image;
  for (const Point& p_H : sight.map.cloud_H()) {
    map_image.add(T_L_W * p_H);
  }
  for (const Point& p_W : sight.filtered.returns_W[0]) {
    scan_image.add(T_L_W * p_W);
  }
  std::vector<bool> visible(sight.map.subset_H().size(), false);
  for (const VisiblePoint& v : sight.visible) {
    visible[v.index] = true;
  }
  std::size_t expected = 0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const Point p_L = T_L_W * sight.map.subset_H()[i];
    const float r = p_L.norm();
    const bool in_view = std::abs(std::atan2(p_L.y(), p_L.x())) < radians(59.0) &&
                         std::abs(std::asin(p_L.z() / r)) < radians(44.0) && r < 25.0F;
    if (in_view && r <= map_image.nearest(p_L) + 0.4F && r <= scan_image.nearest(p_L) + 0.4F) {
      ++expected;
      found += visible[i] ? 1 : 0;
    }
  }
  EXPECT_GT(expected, 1000u);
  EXPECT_GT(found, expected * 90 / 100) << "beside an edge, what lies far behind it is left out too";
  EXPECT_LT(sight.visible.size(), expected * 108 / 100) << "the rim of the view is left out of `expected`";
}

TEST(Visibility, PointsBehindTheScansReturnsAreNotExpected) {
  Sight sight;
  sight.look(&sight.ship);
  const std::size_t clear = sight.visible.size();
  for (Point& p_W :
       sight.filtered.returns_W[0]) {  // a chute 5 m before the sensor hides the half with y > -3
    const Point d = p_W - sight.sensor.mount.translation().cast<float>();
    if (d.y() > 0.0F) {
      p_W = sight.sensor.mount.translation().cast<float>() + 5.0F * d.normalized();
    }
  }
  sight.views[0].rebuild(sight.filtered.returns_W[0], sight.sensor.mount);
  Visibility(25.0).run(sight.map, sight.map.subset_H(), Pose::Identity(), sight.views,
                       std::vector{sight.sensor}, sight.visible);
  EXPECT_LT(sight.visible.size(), clear * 7 / 10);
  for (const VisiblePoint& v : sight.visible) {
    EXPECT_LT(sight.map.subset_H()[v.index].y(), -2.0F);
  }
}

TEST(Visibility, APointIsAskedOfTheNearestLidarThatSeesIt) {
  const AnalyticShip ship = AnalyticShip::bulk_carrier();
  const HullMap map(ship.map(0.1, 1));
  const std::vector sensors = {testing::looking_down({-9.0, -3.0, 21.0}),
                               testing::looking_down({6.0, -3.0, 15.0})};
  const auto seen_by = [&](std::span<const SensorConfig> some) {
    std::vector<ScanView> views(some.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
      FilteredScan filtered;
      ScanFilter({}, {some[i]}, std::nullopt)
          .run(testing::scan_ship(&ship, some[i], {}), testing::joints_at_rest(1.0), {}, filtered);
      views[i].rebuild(filtered.returns_W[0], some[i].mount);
    }
    std::vector<VisiblePoint> visible;
    Visibility(40.0).run(map, map.subset_H(), Pose::Identity(), views, some, visible);
    return visible;
  };
  std::map<std::uint32_t, float> nearest;
  for (const SensorConfig& sensor : sensors) {
    for (const VisiblePoint& v : seen_by(std::span(&sensor, 1))) {
      const auto [at, added] = nearest.emplace(v.index, v.p_L.norm());
      at->second = std::min(at->second, v.p_L.norm());
    }
  }
  const std::vector<VisiblePoint> both = seen_by(sensors);
  EXPECT_EQ(both.size(), nearest.size());
  std::size_t of_second = 0;
  for (const VisiblePoint& v : both) {
    ASSERT_TRUE(nearest.contains(v.index));
    EXPECT_FLOAT_EQ(v.p_L.norm(), nearest[v.index]);
    of_second += v.lidar;
  }
  EXPECT_GT(of_second, both.size() / 4);
  EXPECT_LT(of_second, both.size());
}

TEST(Visibility, FieldOfViewIsWhereReturnsEverCameFrom) {
  Sight sight;
  sight.look(&sight.ship);
  const std::size_t all = sight.visible.size();
  sight.look(nullptr);  // the ship is gone, the quay lies deeper: what was looked at stays looked at
  EXPECT_GT(sight.visible.size(), all * 9 / 10);
}

}  // namespace
}  // namespace hulltrack
