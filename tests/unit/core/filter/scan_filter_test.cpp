#include "core/filter/scan_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

MeasurementTime at_ms(int ms) { return MeasurementTime{milliseconds(ms)}; }

LidarPoint point(float x, float y, float z) { return {x, y, z, 0, 0, 0, 0}; }

/// A segment of its own for these points, at the end of the scan.
void add_segment(Scan& scan, int ms, std::initializer_list<LidarPoint> points, std::uint16_t lidar = 0) {
  scan.segments.push_back({at_ms(ms), static_cast<std::uint32_t>(scan.points.size()),
                           static_cast<std::uint32_t>(points.size()), lidar});
  scan.points.insert(scan.points.end(), points);
}

/// Travel 0..10 m within 100 ms; slew and luff at rest.
JointHistory travelling() {
  JointHistory joints;
  joints.add({at_ms(0), {0.0, 0.0, 0.0}});
  joints.add({at_ms(100), {10.0, 0.0, 0.0}});
  return joints;
}

FilteredScan run(const ScanFilter& filter, const Scan& scan, const JointHistory& joints) {
  FilteredScan out;
  filter.run(scan, joints, {}, out);
  return out;
}

void expect_points(const Cloud& cloud, const Cloud& expected) {
  ASSERT_EQ(cloud.size(), expected.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT((cloud[i] - expected[i]).norm(), 1e-5F) << i << ": " << cloud[i].transpose();
  }
}

TEST(ScanFilter, EachSegmentIsMovedWithTheJointsAtItsOwnTime) {
  Scan scan;
  add_segment(scan, 0, {point(5, 0, 0)});
  add_segment(scan, 25, {point(5, 0, 0), point(0, 5, 0)});
  add_segment(scan, 100, {point(5, 0, 0)});
  const ScanFilter filter({}, {SensorConfig{}}, std::nullopt);
  expect_points(run(filter, scan, travelling()).hull_W, {{5, 0, 0}, {7.5F, 0, 0}, {2.5F, 5, 0}, {15, 0, 0}});
}

TEST(ScanFilter, SweptWallIsFlatAgainAlthoughTheBoomSlews) {
  // A wall at x = 20 m in W, looked at straight by a LiDAR that turns with the boom, 0 to 9 deg in 90 ms.
  // The range to it along the LiDAR's x axis is 20 m / cos(slew).
  JointHistory joints;
  Scan scan;
  for (int ms = 0; ms <= 90; ms += 10) {
    const double slew = radians(0.1 * ms);
    joints.add({at_ms(ms), {0.0, slew, 0.0}});
    add_segment(scan, ms, {point(static_cast<float>(20.0 / std::cos(slew)), 0, 0)});
  }
  const FilteredScan out = run(ScanFilter({}, {SensorConfig{}}, std::nullopt), scan, joints);
  ASSERT_EQ(out.hull_W.size(), 10u);
  for (std::size_t i = 0; i < out.hull_W.size(); ++i) {
    EXPECT_NEAR(out.hull_W[i].x(), 20.0F, 1e-4F);
    EXPECT_NEAR(out.hull_W[i].y(), 20.0 * std::tan(radians(static_cast<double>(i))), 1e-4);
  }
}

TEST(ScanFilter, EachLidarHasItsOwnMount) {
  SensorConfig left;
  left.mount = pose_from_xyz_rpy_deg({0, 3, 0}, {0, 0, 90});
  SensorConfig down;
  down.mount = pose_from_xyz_rpy_deg({0, 0, 10}, {0, 90, 0});
  Scan scan;
  add_segment(scan, 0, {point(5, 0, 0)}, 0);
  add_segment(scan, 0, {point(5, 0, 0)}, 1);
  const FilteredScan out = run(ScanFilter({}, {left, down}, std::nullopt), scan, travelling());
  expect_points(out.hull_W, {{0, 8, 0}, {0, 0, 5}});  // x_L is +y of W; x_L is -z of W
  ASSERT_EQ(out.returns_W.size(), 2u);
  expect_points(out.returns_W[0], {{0, 8, 0}});
  expect_points(out.returns_W[1], {{0, 0, 5}});
}

TEST(ScanFilter, RangeLimitsIncludeTheirEndsAndJudgeTheDistanceNotAnAxis) {
  SensorConfig sensor;
  sensor.min_range = 2.0;
  sensor.max_range = 50.0;
  Scan scan;
  add_segment(scan, 0,
              {point(1.99F, 0, 0), point(2, 0, 0), point(0, -50, 0), point(0, 0, 50.01F), point(0, 0, 0),
               point(1.5F, 1.5F, 1.5F), point(30, 30, 30)});
  expect_points(run(ScanFilter({}, {sensor}, std::nullopt), scan, travelling()).hull_W,
                {{2, 0, 0}, {0, -50, 0}, {1.5F, 1.5F, 1.5F}});
}

TEST(ScanFilter, ExcludeBoxesAreInTheLidarsFrameAndTheRegionIsInTheWorld) {
  SensorConfig sensor;
  sensor.mount.translation() = Eigen::Vector3d(100, 0, 0);
  sensor.exclude = {{{4, -1, -1}, {6, 1, 1}}, {{-6, -1, -1}, {-4, 1, 1}}};
  const Box region{{90, -20, -20}, {110, 20, 20}};
  Scan scan;
  // In a box; in the other; beside both; would be in a box if boxes were in W; outside the region.
  add_segment(scan, 0, {point(5, 0, 0), point(-5, 0, 0), point(5, 2, 0), point(-95, 0, 0), point(15, 0, 0)});
  const FilteredScan out = run(ScanFilter({}, {sensor}, region), scan, travelling());
  expect_points(out.hull_W, {{105, 2, 0}});
  EXPECT_EQ(out.returns_W[0].size(), 5u) << "all of them are what the LiDAR saw";
}

TEST(ScanFilter, PointsThatAreNotFiniteAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Scan scan;
  add_segment(scan, 0,
              {point(kNan, 5, 5), point(5, kNan, 5), point(5, 5, kNan), point(kInfinity, 0, 0),
               point(0, -kInfinity, 0), point(3, 0, 0)});
  const FilteredScan out = run(ScanFilter({}, {SensorConfig{}}, std::nullopt), scan, travelling());
  expect_points(out.hull_W, {{3, 0, 0}});
  EXPECT_EQ(out.returns_W[0].size(), 1u);
  EXPECT_EQ(out.segments_left_out, 0u);
}

TEST(ScanFilter, SegmentsWithoutJointsAreLeftOutAndCounted) {
  JointHistory joints = travelling();
  joints.add({at_ms(400), {20.0, 0.0, 0.0}});  // a gap of 300 ms before it
  Scan scan;
  add_segment(scan, -1, {point(5, 0, 0)});   // before the oldest
  add_segment(scan, 50, {point(5, 0, 0)});   // bracketed
  add_segment(scan, 250, {point(5, 0, 0)});  // in the gap
  add_segment(scan, 401, {point(5, 0, 0)});  // after the newest
  const ScanFilter filter({}, {SensorConfig{}}, std::nullopt);
  const FilteredScan out = run(filter, scan, joints);
  expect_points(out.hull_W, {{10, 0, 0}});
  EXPECT_EQ(out.segments_left_out, 3u);
  EXPECT_EQ(run(filter, scan, JointHistory{}).segments_left_out, 4u);
}

TEST(ScanFilter, SegmentsOfNoLidarOrOutsideTheArrayAreLeftOutAndCounted) {
  Scan scan;
  add_segment(scan, 0, {point(5, 0, 0)}, 1);  // there is one LiDAR only
  add_segment(scan, 0, {point(6, 0, 0)});
  scan.segments.push_back({at_ms(0), 1, 2, 0});            // one point too many
  scan.segments.push_back({at_ms(0), 3, 0, 0});            // begins beyond the end
  scan.segments.push_back({at_ms(0), 1, 0xFFFFFFFFU, 0});  // first + count overflows
  const FilteredScan out = run(ScanFilter({}, {SensorConfig{}}, std::nullopt), scan, travelling());
  expect_points(out.hull_W, {{6, 0, 0}});
  EXPECT_EQ(out.segments_left_out, 4u);
}

TEST(ScanFilter, ReturnsOfAHullThatDriftsLieWhereTheyAreInTheMiddleOfTheScan) {
  // A point of the hull turns about the vertical through `about` by w t and moves on by v t, t from the
  // middle.
  HullDrift drift;
  drift.about_W = {10, 5, 0};
  drift.velocity = {0.4, -0.2, 0.1};
  drift.turning = {0, 0, radians(2.0)};
  const Eigen::Vector3d at_middle(20, -3, 2);
  Scan scan;
  scan.begin = at_ms(0);
  scan.end = at_ms(100);
  Cloud expected;
  for (const int ms : {0, 20, 50, 90, 100}) {
    const double t = 0.001 * (ms - 50);
    const double c = std::cos(radians(2.0) * t);
    const double s = std::sin(radians(2.0) * t);
    const Eigen::Vector3d d = at_middle - drift.about_W;
    const Eigen::Vector3d seen = drift.about_W +
                                 Eigen::Vector3d(c * d.x() - s * d.y(), s * d.x() + c * d.y(), d.z()) +
                                 t * drift.velocity;
    const Eigen::Vector3f p = seen.cast<float>();
    add_segment(scan, ms, {point(p.x(), p.y(), p.z())});
    expected.push_back(at_middle.cast<float>());
  }
  JointHistory at_rest;
  at_rest.add({at_ms(0), {}});
  at_rest.add({at_ms(100), {}});
  FilteredScan out;
  ScanFilter({}, {SensorConfig{}}, std::nullopt).run(scan, at_rest, drift, out);
  // The turn is about where the point of the hull is, which has moved by 2 cm at most: 2 cm * 0.1 deg.
  ASSERT_EQ(out.hull_W.size(), expected.size());
  for (const Point& p : out.hull_W) {
    EXPECT_LT((p - expected.front()).norm(), 1e-4F) << p.transpose();
  }
}

TEST(ScanFilter, OutputOfTheScanBeforeIsReplaced) {
  Scan scan;
  add_segment(scan, 0, {point(5, 0, 0)});
  const ScanFilter filter({}, {SensorConfig{}}, std::nullopt);
  FilteredScan out;
  filter.run(scan, JointHistory{}, {}, out);
  EXPECT_EQ(out.segments_left_out, 1u);
  filter.run(scan, travelling(), {}, out);
  filter.run(scan, travelling(), {}, out);
  EXPECT_EQ(out.segments_left_out, 0u);
  EXPECT_EQ(out.returns_W[0].size(), 1u);
  EXPECT_EQ(out.hull_W.size(), 1u);
}

}  // namespace
}  // namespace hulltrack
