#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "daemon/simulator/berth/loader_machine.hpp"
#include "daemon/simulator/berth/loader_motion.hpp"
#include "daemon/simulator/berth/plc_model.hpp"
#include "daemon/simulator/ship/hull_motion.hpp"
#include "daemon/simulator/ship/ship_conduct.hpp"

namespace hulltrack {
namespace {

const Eigen::Vector3d kReference(-0.9, 4.9, 3.3);

TEST(HullMotion, MooringStaysWithinItsAmplitudes) {
  HullMotionConfig config;
  config.surge = {0.05, 50.0, 150.0};
  config.roll = {radians(0.1), 6.0, 15.0};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const HullMotion motion(config, kReference, seed);
    double largest = 0.0;
    for (double t = 0.0; t < 2000.0; t += 0.5) {
      const ShipPose pose = motion.pose(t);
      EXPECT_LE(std::abs(pose.displacement.x()), 0.05);
      EXPECT_LE(std::abs(pose.rpy.x()), radians(0.1));
      EXPECT_EQ(pose.displacement.y(), 0.0);
      largest = std::max(largest, std::abs(pose.displacement.x()));
    }
    EXPECT_GT(largest, 0.02) << "seed " << seed;
  }
}

TEST(HullMotion, ReferencePointMovesByTheDisplacement) {
  const HullMotion motion(conduct::uneasy(), kReference, 5);
  for (const double t : {0.0, 7.3, 500.0}) {
    const Eigen::Vector3d moved = motion.T_W_H(t) * kReference - kReference;
    EXPECT_NEAR((moved - motion.pose(t).displacement).norm(), 0.0, 1e-12);
    EXPECT_NEAR((rpy_from_rotation(motion.T_W_H(t).linear()) - motion.pose(t).rpy).norm(), 0.0, 1e-12);
  }
}

TEST(HullMotion, DraftSinksAtItsRate) {
  HullMotionConfig config;
  config.draft_rate = 1.0 / 3600.0;
  const HullMotion motion(config, kReference, 1);
  EXPECT_NEAR(motion.pose(360.0).displacement.z(), -0.1, 1e-12);
}

TEST(HullMotion, AListTurnsTheShipAboutTheReferencePointWithinItsTime) {
  HullMotionConfig config;
  config.courses = {conduct::listing(5.0, 12.0, {radians(3.0), 0.0, 0.0})};
  const HullMotion motion(config, kReference, 1);
  EXPECT_EQ(motion.pose(5.0).rpy.x(), 0.0);
  EXPECT_NEAR(motion.pose(11.0).rpy.x(), radians(1.5), 1e-12);
  EXPECT_NEAR(motion.pose(17.0).rpy.x(), radians(3.0), 1e-12);
  EXPECT_EQ(motion.pose(17.0).displacement.norm(), 0.0);
  EXPECT_EQ(under_way(config), std::nullopt);
}

TEST(HullMotion, TheEbbTakesTheShipAlongAndCargoSinksHerInTheWater) {
  HullMotionConfig config;
  config.ebb = {0.0, 0.02, 0.01, 2.8};
  config.courses = {conduct::shifted(0.0, {0.0, 0.0, -4.2}, 0.03, 0.015)};
  const HullMotion motion(config, kReference, 1);
  EXPECT_NEAR(motion.ebb(500.0), 2.8, 1e-12);
  EXPECT_NEAR(motion.pose(500.0).displacement.z(), -7.0, 1e-12);
  EXPECT_EQ(under_way(config), std::nullopt);
}

TEST(HullMotion, RunKeepsItsSpeedAndAccelerationAndArrives) {
  const hulltrack::Run run{10.0, 0.2, 0.02, 22.6};
  double previous = run_distance(run, 0.0);
  double previous_speed = 0.0;
  constexpr double kStep = 0.05;
  for (double t = kStep; t < 200.0; t += kStep) {
    const double s = run_distance(run, t);
    const double speed = (s - previous) / kStep;
    EXPECT_LE(speed, 0.2 + 1e-9);
    EXPECT_GE(speed, -1e-9);
    EXPECT_LE(std::abs(speed - previous_speed) / kStep, 0.02 + 1e-6);
    previous = s;
    previous_speed = speed;
  }
  EXPECT_NEAR(previous, 22.6, 1e-9);
  EXPECT_EQ(run_distance(run, 10.0), 0.0);
}

TEST(HullMotion, EndlessRunGoesOn) {
  const hulltrack::Run run{80.0, 1.5, 0.08, std::numeric_limits<double>::infinity()};
  EXPECT_NEAR(run_distance(run, 85.0), 0.5 * 0.08 * 25.0, 1e-12);
  EXPECT_NEAR(run_distance(run, 180.0) - run_distance(run, 179.0), 1.5, 1e-9);
}

TEST(LoaderMotion, KeepsWithinItsWorkingRangeSpeedsAndAccelerations) {
  const LoaderLimits limits = loader_limits();
  constexpr double kStep = 0.02;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const LoaderMotion motion(limits, 300.0, seed);
    const auto check = [&](const AxisLimits& axis, double Joints::*joint, const char* name) {
      double lowest = 1e9;
      double highest = -1e9;
      double previous_speed = 0.0;
      for (double t = 0.0; t < 320.0; t += kStep) {
        const double here = motion.at(t).*joint;
        const double speed = (motion.at(t + kStep).*joint - here) / kStep;
        EXPECT_GE(here, axis.low) << name;
        EXPECT_LE(here, axis.high) << name;
        EXPECT_LE(std::abs(speed), axis.speed + 1e-9) << name;
        EXPECT_LE(std::abs(speed - previous_speed) / kStep, axis.acceleration + 1e-6) << name << " at " << t;
        previous_speed = speed;
        lowest = std::min(lowest, here);
        highest = std::max(highest, here);
      }
      EXPECT_GE(highest - lowest, axis.shortest_move) << name << " never worked, seed " << seed;
    };
    check(limits.travel, &Joints::d_x, "travel");
    check(limits.slew, &Joints::theta_r, "slew");
    check(limits.luff, &Joints::theta_p, "luff");
  }
}

TEST(PlcModel, PresentsQuantisedEncodersOfTheLastCycle) {
  const LoaderMotion loader(loader_limits(), 60.0, 9);
  const PlcModel plc(loader, {}, 9);
  for (double t = 0.0; t < 60.0; t += 0.0137) {
    const Joints joints = plc.at(t).joints;
    EXPECT_NEAR(joints.d_x, std::round(joints.d_x * 1000.0) / 1000.0, 1e-12);
    const double oldest = PlcModel::kEncoderDelay + PlcModel::kCycle;
    const Joints now = loader.at(t);
    EXPECT_LE(std::abs(joints.d_x - now.d_x), 0.4 * oldest + 0.0005 + 1e-9);
    EXPECT_LE(std::abs(joints.theta_r - now.theta_r), radians(1.0) * oldest + 2.5e-5);
  }
}

TEST(PlcModel, MeanAgeIsTheStatedLatency) {
  // A loader in one long travel: the value's lag over the speed is its age.
  const LoaderLimits limits{.travel = {0.0, 100.0, 0.4, 0.12, 60.0, 100.0},
                            .slew = {0.0, 1.0, 0.02, 0.01, 0.1, 1.0},
                            .luff = {0.0, 1.0, 0.02, 0.01, 0.1, 1.0}};
  const LoaderMotion loader(limits, 2000.0, 3);
  const PlcModel plc(loader, {.travel_step = 1e-9}, 3);
  double age = 0.0;
  int samples = 0;
  for (double t = 0.0; t < 2000.0; t += 0.00217) {
    const double speed = (loader.at(t).d_x - loader.at(t - 0.05).d_x) / 0.05;
    if (std::abs(std::abs(speed) - 0.4) > 1e-6) continue;
    age += (loader.at(t).d_x - plc.at(t).joints.d_x) / speed;
    ++samples;
  }
  ASSERT_GT(samples, 1000);
  EXPECT_NEAR(age / samples, plc.mean_latency(), 1e-4);
}

TEST(PlcModel, HeartbeatChangesOnceACycle) {
  const LoaderMotion loader(Joints{1.0, 1.5, 0.0});
  const PlcModel plc(loader, {}, 4);
  int changes = 0;
  std::uint16_t last = plc.at(-1.0).heartbeat;
  for (double t = -1.0; t < 10.0; t += 0.001) {
    const std::uint16_t heartbeat = plc.at(t).heartbeat;
    if (heartbeat != last) {
      ++changes;
      EXPECT_EQ(static_cast<std::uint16_t>(last + 1), heartbeat);
    }
    last = heartbeat;
  }
  EXPECT_NEAR(changes, 11.0 / PlcModel::kCycle, 1.0);
}

TEST(PlcModel, GatewayDelaysEveryCycleWithinItsJitterAndInOrder) {
  const LoaderMotion loader(Joints{1.0, 1.5, 0.0});
  const Gateway gateway{.delay = 0.0165, .jitter = 0.005};
  const PlcModel plc(loader, {}, 4, gateway);
  EXPECT_NEAR(plc.mean_latency(), 0.025, 1e-12);
  const PlcModel direct(loader, {}, 4);
  double sum = 0.0;
  double least = 1.0;
  double most = 0.0;
  constexpr int kCycles = 2000;
  for (int i = 0; i < kCycles; ++i) {
    const double from = plc.presented_from(i);
    const double delay = from - direct.presented_from(i);
    sum += delay;
    least = std::min(least, delay);
    most = std::max(most, delay);
    EXPECT_LT(from, plc.presented_from(i + 1));
    EXPECT_EQ(plc.at(from + 1e-9).heartbeat, static_cast<std::uint16_t>(i));
    EXPECT_EQ(plc.at(from - 1e-9).heartbeat, static_cast<std::uint16_t>(i - 1));
  }
  EXPECT_GE(least, 0.0115);
  EXPECT_LE(most, 0.0215);
  EXPECT_GT(most - least, 0.009);
  EXPECT_NEAR(sum / kCycles, 0.0165, 4.0 * 0.005 / std::sqrt(3.0 * kCycles));  // 4 sigma of the mean
}

TEST(LoaderMotion, AtRestExactlyWhileNoJointMoves) {
  const LoaderMotion motion(loader_limits(), 120.0, 8);
  int resting = 0;
  int moving = 0;
  for (double t = 0.1; t < 119.0; t += 0.1) {
    constexpr double kMoment = 0.01;  // s, shorter than any move or rest
    if (motion.at_rest(t) != motion.at_rest(t + kMoment)) continue;
    const Joints here = motion.at(t);
    const Joints then = motion.at(t + kMoment);
    const bool still = here.d_x == then.d_x && here.theta_r == then.theta_r && here.theta_p == then.theta_p;
    EXPECT_EQ(motion.at_rest(t), still) << t;
    (still ? resting : moving) += 1;
  }
  EXPECT_GT(resting, 100);
  EXPECT_GT(moving, 100);
}

TEST(LoaderMotion, AHurriedOneIsHardlyEverAtRestAndOnePassCoversItsRange) {
  const LoaderMotion hurried(hurried_loader_limits(), 300.0, 5);
  int resting = 0;
  for (int i = 0; i < 3000; ++i) resting += hurried.at_rest(0.1 * i) ? 1 : 0;
  EXPECT_LT(resting, 300);
  const LoaderLimits limits = passing_loader_limits();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const LoaderMotion passing(limits, 66.0, seed);
    constexpr double kArrived = 65.5;  // s: 3 s of rest, 60 s at full speed, 2.5 s for the ramps
    const double ends = std::abs(passing.at(kArrived).d_x - passing.at(0.0).d_x);
    EXPECT_NEAR(ends, limits.travel.high - limits.travel.low, 1e-9);
  }
}

}  // namespace
}  // namespace hulltrack
