#include "core/tracking/hull_tracker.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "core/geometry/health_contract.hpp"
#include "tests/support/analytic_ship.hpp"

namespace hulltrack {
namespace {

using testing::AnalyticShip;
using testing::ScanOptions;

TrackerConfig tracker_config() {
  TrackerConfig config;
  config.hull.reference_point = {3.0, -6.0, 1.4};
  config.hull.region = Box{{-40, -20, -10}, {40, 20, 20}};
  return config;
}

const SensorConfig& sensor() {
  static const SensorConfig s = testing::looking_down({-1.0, -3.0, 17.0});
  return s;
}

Pose displaced(const Eigen::Vector3d& t, const Eigen::Vector3d& rpy_deg = Eigen::Vector3d::Zero()) {
  return pose_from_xyz_rpy_deg(t, rpy_deg);
}

/// Enough to search the berth (13 starts, 4 a frame), to judge what is in view and to recover (5).
constexpr int kFramesToBelieve = 30;

/// A tracker over the analytic ship, and what it says frame after frame.
class Track {
 public:
  explicit Track(const TrackerConfig& config = tracker_config())
      : tracker_(config, {}, {sensor()}, testing::bulk_carrier_map()) {}

  TrackResult step(const AnalyticShip* ship, ScanOptions options, const FrameInputs& inputs = {}) {
    options.frame = frame_++;
    return tracker_.process(testing::scan_ship(ship, sensor(), options), joints_, inputs);
  }
  TrackResult settle(const Pose& T_W_H) {
    TrackResult result;
    for (int i = 0; i < kFramesToBelieve && !result.health; ++i) {
      result = step(&ship_, {.T_W_H = T_W_H});
    }
    return result;
  }
  /// Not one return for so many frames.
  void blind(int frames) {
    for (int i = 0; i < frames; ++i) {
      EXPECT_FALSE(step(nullptr, {.drop = 1.1}).health);
    }
  }
  const AnalyticShip& ship() const { return ship_; }

 private:
  AnalyticShip ship_ = AnalyticShip::bulk_carrier();
  HullTracker tracker_;
  JointHistory joints_ = testing::joints_at_rest(100.0);
  std::uint32_t frame_ = 0;
};

double error(const TrackResult& result, const Pose& T_W_H) {
  const Eigen::Vector3d p = tracker_config().hull.reference_point;
  return (result.pose.T_W_H * p - T_W_H * p).norm();
}

TEST(HullTracker, FindsAMooredHullAndSaysSo) {
  for (const auto& [t, rpy] :
       {std::pair{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0)},
        std::pair{Eigen::Vector3d(0.04, -0.03, -0.05), Eigen::Vector3d(0.05, 0.03, -0.04)}}) {
    Track track;
    const Pose T_W_H = displaced(t, rpy);
    const TrackResult result = track.settle(T_W_H);
    EXPECT_EQ(result.state, State::tracking) << result.reason;
    EXPECT_TRUE(result.health);
    EXPECT_LT(error(result, T_W_H), 0.03);
    ASSERT_TRUE(result.metrics.q1_expected);
    EXPECT_NEAR(result.metrics.q1 / *result.metrics.q1_expected, 1.0, 0.25);
    EXPECT_GT(result.sigma_translation, 0.0);
    EXPECT_LT(result.sigma_translation, 0.05);
  }
}

TEST(HullTracker, RegistersWithJointsOnTrialButIsNotHealthy) {
  const AnalyticShip ship = AnalyticShip::bulk_carrier();
  HullTracker tracker(tracker_config(), {}, {sensor()}, testing::bulk_carrier_map());
  JointHistory joints;
  for (int i = 0; i < 200; ++i) {  // every twentieth of a second
    joints.add({measurement_time_from_ns(i * std::int64_t{50'000'000}), {}, true});
  }
  for (std::uint32_t frame = 0; frame < 30; ++frame) {
    const Scan scan = testing::scan_ship(&ship, sensor(), {.frame = frame});
    const TrackResult result =
        tracker.process(scan, joints, {.standing = fault::plc_value, .joint_trouble = "travel waits"});
    EXPECT_TRUE(result.registered);
    ASSERT_FALSE(result.health);
    EXPECT_FALSE(result.joints_confirmed);
    EXPECT_NE(result.faults & fault::plc_value, 0);
  }
}

TEST(HullTracker, ExpectsQ1OfThePointsThatItIsTakenOf) {
  const auto metrics_within = [](double metric_range) {
    TrackerConfig config = tracker_config();
    config.health.metric_range = metric_range;
    const AnalyticShip ship = AnalyticShip::bulk_carrier();
    HullTracker tracker(config, {}, {sensor()}, testing::bulk_carrier_map());
    return tracker.process(testing::scan_ship(&ship, sensor(), {}), testing::joints_at_rest(30.0), {})
        .metrics;
  };
  const DistanceMetrics near = metrics_within(18.0);
  const DistanceMetrics far = metrics_within(40.0);
  ASSERT_TRUE(near.q1_expected && far.q1_expected);
  EXPECT_LT(*near.q1_expected, 0.95 * *far.q1_expected) << "rays are denser near the sensor";
  EXPECT_NEAR(near.q1 / *near.q1_expected, 1.0, 0.2);
  EXPECT_NEAR(far.q1 / *far.q1_expected, 1.0, 0.2);
}

TEST(HullTracker, BelievesWhatItSeesFartherOffWhereFewPointsAreWithinTheMetricsRange) {
  TrackerConfig config = tracker_config();
  config.health.metric_range = 16.3;
  Track track(config);
  const TrackResult result = track.settle(displaced({0.04, -0.03, -0.05}));
  EXPECT_GT(result.metrics.points, 0U);
  EXPECT_FALSE(result.metrics.q1_expected);
  EXPECT_TRUE(result.metrics.few_surfels);
  EXPECT_EQ(result.state, State::tracking) << result.reason;
  EXPECT_EQ(result.faults, 0);
}

TEST(HullTracker, TellsTheMotionOfAHealthyHullAlone) {
  Track track;
  const TrackResult first = track.step(&track.ship(), {.T_W_H = displaced({0, 0, -0.05})});
  EXPECT_FALSE(first.health);
  EXPECT_FALSE(first.motion.now);
  const TrackResult result = track.settle(displaced({0.04, 0.0, -0.05}, {0.05, 0.0, 0.0}));
  ASSERT_TRUE(result.health) << result.reason;
  ASSERT_TRUE(result.motion.now);
  EXPECT_NEAR(result.motion.now->draft, 0.05, 0.03);
  EXPECT_NEAR(result.motion.now->surge, 0.04, 0.03);
  EXPECT_NEAR(result.motion.now->heel, radians(0.05), radians(0.1));
  EXPECT_FALSE(result.motion.rate) << "of half a second";
}

double turn_error(const TrackResult& result, const Pose& T_W_H) {
  return rotation_angle(result.pose.T_W_H.linear().transpose() * T_W_H.linear());
}

TEST(HullTracker, FindsAHullThatLiesElsewhereAndIsNeverHealthyOffIt) {
  for (const auto& [t, yaw] :
       {std::pair{Eigen::Vector3d(1, 0, 0), 0.0}, std::pair{Eigen::Vector3d(-0.5, 0, 0), 0.0},
        std::pair{Eigen::Vector3d(5, 0, 0), 0.0}, std::pair{Eigen::Vector3d(0, 1.0, 0), 0.0},
        std::pair{Eigen::Vector3d(1, 1, 0), 0.0}, std::pair{Eigen::Vector3d(0, 0, 1.5), 0.0},
        std::pair{Eigen::Vector3d(0, 0, -2), 0.0}, std::pair{Eigen::Vector3d(0, 0, 0), 1.0}}) {
    Track track;
    const Pose T_W_H = displaced(t, {0, 0, yaw});
    bool found = false;
    bool believed = false;
    for (int i = 0; i < kFramesToBelieve && !believed; ++i) {
      const TrackResult result = track.step(&track.ship(), {.T_W_H = T_W_H});
      const bool right = error(result, T_W_H) < HealthContract::kPosition &&
                         turn_error(result, T_W_H) < HealthContract::kAttitude;
      found = found || right;
      believed = result.health;
      EXPECT_TRUE(!believed || right)
          << t.transpose() << ", yaw " << yaw << ": error " << error(result, T_W_H);
    }
    EXPECT_TRUE(found) << t.transpose() << ", yaw " << yaw;
    EXPECT_TRUE(believed) << t.transpose() << ", yaw " << yaw;
  }
}

TEST(HullTracker, FindsAHullThatMovedByMetresUnseenAndIsNeverHealthyOffIt) {
  constexpr int kFramesToFind = 20;  // 2 s
  for (const auto& [t, yaw, seconds] : {std::tuple{Eigen::Vector3d(-4, 0, 0.5), 0.0, 30},
                                        {Eigen::Vector3d(-11, 0, -1), 0.0, 45},
                                        {Eigen::Vector3d(6, 0, 0), 0.0, 30},
                                        {Eigen::Vector3d(14, 0, 2), 0.5, 60},
                                        {Eigen::Vector3d(-4, 1.5, 0.5), -0.5, 30}}) {
    Track track;
    ASSERT_TRUE(track.settle(Pose::Identity()).health);
    track.blind(10 * seconds);
    const Pose T_W_H = displaced(t, {0, 0, yaw});
    bool found = false;
    bool believed = false;
    for (int i = 0; i < kFramesToFind; ++i) {
      const TrackResult result = track.step(&track.ship(), {.T_W_H = T_W_H});
      const bool right = error(result, T_W_H) < HealthContract::kPosition &&
                         turn_error(result, T_W_H) < HealthContract::kAttitude;
      found = found || right;
      believed = result.health;
      EXPECT_TRUE(right || !result.health)
          << t.transpose() << ", frame " << i << ": error " << error(result, T_W_H);
    }
    EXPECT_TRUE(found) << t.transpose();
    EXPECT_TRUE(believed) << t.transpose();
  }
}

TEST(HullTracker, AShipThatLeftUnseenIsNeverHealthyAgain) {
  const AnalyticShip other = AnalyticShip::other_carrier();
  for (const AnalyticShip* left : {static_cast<const AnalyticShip*>(nullptr), &other}) {
    Track track;
    ASSERT_TRUE(track.settle(Pose::Identity()).health);
    track.blind(400);
    for (int i = 0; i < 50; ++i) {
      const TrackResult result = track.step(left, {});
      EXPECT_FALSE(result.health) << i;
      EXPECT_FALSE(result.reason.empty());
    }
  }
}

TEST(HullTracker, LosesAHullThatDepartsInAnyDirection) {
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                           Eigen::Vector3d(0.7, 0.7, 0), Eigen::Vector3d(-1, 0, 0)}) {
    Track track;
    ASSERT_TRUE(track.settle(Pose::Identity()).health);
    for (int i = 1; i <= 40; ++i) {
      const double t = 0.1 * i;
      const Pose T_W_H = displaced(0.5 * 0.1 * t * t * direction);  // 0.1 m/s^2
      const TrackResult result = track.step(&track.ship(), {.T_W_H = T_W_H});
      ASSERT_TRUE(!result.health || error(result, T_W_H) < HealthContract::kPosition)
          << direction.transpose() << " at " << t << " s";
      ASSERT_TRUE(!result.health || 0.1 * t < 0.3 + 0.1 * 0.5) << "0.5 s after passing max_speed";
    }
  }
}

TEST(HullTracker, IsNotHealthyOnAnEmptyBerthOrAnotherShip) {
  Track track;
  const AnalyticShip other = AnalyticShip::other_carrier();
  ASSERT_TRUE(track.settle(Pose::Identity()).health);
  for (int i = 0; i < 8; ++i) {
    EXPECT_FALSE(track.step(nullptr, {}).health);
  }
  for (int i = 0; i < 8; ++i) {
    EXPECT_FALSE(track.step(&other, {}).health);
  }
}

TEST(HullTracker, SameCallsGiveTheSameBits) {
  Track a;
  Track b;
  for (int i = 0; i < 7; ++i) {
    const Pose T_W_H = displaced({0.005 * i, 0, 0});
    const TrackResult ra = a.step(&a.ship(), {.T_W_H = T_W_H});
    const TrackResult rb = b.step(&b.ship(), {.T_W_H = T_W_H});
    EXPECT_EQ(ra.pose.T_W_H.matrix(), rb.pose.T_W_H.matrix());
    EXPECT_EQ(ra.metrics.q1, rb.metrics.q1);
    EXPECT_EQ(ra.state, rb.state);
  }
}

TEST(HullTracker, EmptyScanIsAStateNotACrash) {
  Track track;
  ASSERT_TRUE(track.settle(Pose::Identity()).health);
  const TrackResult result = track.step(nullptr, {.drop = 1.1});
  EXPECT_FALSE(result.registered);
  EXPECT_EQ(result.state, State::lost);
  EXPECT_FALSE(result.metrics.valid);
  EXPECT_FALSE(result.reason.empty());
}

TEST(HullTracker, ScanThatJointsDoNotBracketIsNotRegistered) {
  Track track;
  ASSERT_TRUE(track.settle(Pose::Identity()).health);
  HullTracker tracker(tracker_config(), {}, {sensor()}, testing::bulk_carrier_map());
  ScanOptions options;
  options.frame = 10'000;
  const TrackResult result = tracker.process(testing::scan_ship(&track.ship(), sensor(), options),
                                             testing::joints_at_rest(30.0), {});
  EXPECT_FALSE(result.registered);
  EXPECT_EQ(result.state, State::fault);
  EXPECT_EQ(result.faults, fault::plc_stale);
}

TEST(HullTracker, HoldMeansNoTracking) {
  Track track;
  ASSERT_TRUE(track.settle(Pose::Identity()).health);
  const TrackResult result = track.step(&track.ship(), {}, {.hold = true});
  EXPECT_EQ(result.state, State::held);
  EXPECT_FALSE(result.registered);
}

}  // namespace
}  // namespace hulltrack
