#include "core/localisation/hull_speed_record.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

TEST(HullSpeedRecord, SlopeOfALineIsItsSpeed) {
  HullSpeedRecord record;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.1 * i;
    record.add(MeasurementTime{i * milliseconds(100)}, {0.2 * t, -0.1 * t, 5.0},
               {0.02 * t, -0.1 + 0.03 * t, 0.3 - 0.01 * t});
  }
  ASSERT_TRUE(record.speed());
  EXPECT_TRUE(record.speed()->velocity.isApprox(Eigen::Vector3d(0.2, -0.1, 0.0), 1e-9));
  EXPECT_TRUE(record.speed()->rpy_rate.isApprox(Eigen::Vector3d(0.02, 0.03, -0.01), 1e-9));
}

TEST(HullSpeedRecord, OfAHullThatSpeedsUpItTellsTheSpeedOfTheLastPose) {
  HullSpeedRecord record;
  for (int i = 0; i < 30; ++i) {
    const milliseconds time(100 * i + 10 * (i % 3));  // not quite regular
    const double t = to_seconds(time);
    record.add(MeasurementTime{time}, {0.025 * t * t, 0.0, 0.0}, {0.0, 0.0, 0.002 * t * t});
    if (const auto speed = record.speed()) {
      EXPECT_NEAR(speed->velocity.x(), 0.05 * t, 0.05 * (i < 15 ? 0.2 : 0.03)) << "lag at " << t;
      EXPECT_NEAR(speed->rpy_rate.z(), 0.004 * t, 0.004 * (i < 15 ? 0.2 : 0.03)) << "lag at " << t;
    }
  }
}

TEST(HullSpeedRecord, FewPositionsHaveNoSpeed) {
  HullSpeedRecord record;
  for (int i = 0; i < 3; ++i) {
    record.add(MeasurementTime{i * milliseconds(100)}, {1.0 * i, 0, 0}, Eigen::Vector3d::Zero());
    EXPECT_FALSE(record.speed());
  }
}

TEST(HullSpeedRecord, TwoPosesASecondAreEnough) {
  HullSpeedRecord record;
  for (int i = 0; i < 10; ++i) {
    record.add(MeasurementTime{i * milliseconds(500)}, {0.1 * i, 0, 0}, Eigen::Vector3d::Zero());
  }
  ASSERT_TRUE(record.speed());
  EXPECT_NEAR(record.speed()->velocity.x(), 0.2, 1e-9);
}

TEST(HullSpeedRecord, AfterAGapItBeginsAnew) {
  HullSpeedRecord record;
  for (int i = 0; i < 10; ++i) {
    record.add(MeasurementTime{i * milliseconds(100)}, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  }
  record.add(MeasurementTime{milliseconds(900) + HullSpeedRecord::kLongestGap}, {0.3, 0, 0},
             Eigen::Vector3d::Zero());
  EXPECT_TRUE(record.speed());
  record.add(MeasurementTime{milliseconds(901) + 2 * HullSpeedRecord::kLongestGap}, {0.3, 0, 0},
             Eigen::Vector3d::Zero());
  EXPECT_FALSE(record.speed());
}

}  // namespace
}  // namespace hulltrack
