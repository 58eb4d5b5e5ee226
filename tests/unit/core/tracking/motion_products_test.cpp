#include "core/tracking/motion_products.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace hulltrack {
namespace {

using std::chrono::milliseconds;

constexpr double kPerHour = 1.0 / 3600.0;
const Box kMapped{{-50.0F, 2.0F, -4.0F}, {70.0F, 22.0F, 14.0F}};  // middle (10, 12, 5)
const Eigen::Vector3d kReference{-20.0, 5.0, 3.0};

/// A gauge that sees a hull ten times a second.
class Ship {
 public:
  using Truth = std::function<Pose(double)>;  // T_W_H at t, s
  explicit Ship(Truth truth) : truth_(std::move(truth)) {}

  MotionProducts step(bool health = true) {
    const Pose T_W_H = truth_(0.1 * static_cast<double>(frame_));
    const MeasurementTime time{milliseconds(1'000'000 + 100 * frame_++)};
    if (!health) {  // whatever registration found then must not matter
      return gauge_.update(time, false, {Pose(Eigen::Translation3d(5, 5, 5)), kReference});
    }
    return gauge_.update(time, true, {T_W_H, kReference});
  }
  MotionProducts run(double seconds, bool health = true) {
    MotionProducts last;
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 10.0)); ++i) {
      last = step(health);
    }
    return last;
  }

 private:
  Truth truth_;
  MotionGauge gauge_{kMapped};
  int frame_ = 0;
};

Pose lying(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy_deg) {
  return pose_from_xyz_rpy_deg(xyz, rpy_deg);
}

TEST(MotionProducts, DraftIsThatOfTheMiddleOfTheShipWhereverTheReferencePointIs) {
  // Down by 1 m at the origin, and 1 deg by the end at +X: the middle, 10 m that way, goes down another
  // 10 sin(1 deg), and 5 m of height cost 5 (1 - cos(1 deg)).
  const double a = radians(1.0);
  const MotionProducts products = Ship([](double) { return lying({0, 0, -1}, {0, 1, 0}); }).step();
  ASSERT_TRUE(products.now);
  EXPECT_NEAR(products.now->draft, 1.0 + 10.0 * std::sin(a) + 5.0 * (1.0 - std::cos(a)), 1e-12);
  EXPECT_NEAR(products.now->trim, a, 1e-12);
  EXPECT_NEAR(products.now->heel, 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(products.mapped_length, 120.0);
}

TEST(MotionProducts, HeelIsPositiveWithTheSideAtSmallerYDown) {
  const Pose T_W_H = lying({0, 0, 0}, {2, 0, 0});
  const MotionProducts products = Ship([&](double) { return T_W_H; }).step();
  EXPECT_LT((T_W_H * Eigen::Vector3d(10, 2, 5)).z(), (T_W_H * Eigen::Vector3d(10, 22, 5)).z());
  EXPECT_NEAR(products.now->heel, radians(2.0), 1e-12);
  EXPECT_NEAR(products.now->draft, -12.0 * std::sin(radians(2.0)) + 5.0 * (1.0 - std::cos(radians(2.0))),
              1e-12);
}

TEST(MotionProducts, SurgeIsTheReferencePointsWayAlongTheQuay) {
  const double a = radians(3.0);
  const MotionProducts products = Ship([](double) { return lying({0.4, 7, 0}, {0, 0, 3}); }).step();
  EXPECT_NEAR(products.now->surge, 0.4 - 20.0 * std::cos(a) - 5.0 * std::sin(a) + 20.0, 1e-12);
}

TEST(MotionProducts, RatesOfASteadyMotionAreExact) {
  Ship ship([](double t) {
    return lying({0.02 * t, 0, -1.3 * kPerHour * t}, {0.5 + 2.0 * kPerHour * t, 0, 0});
  });
  const MotionProducts products = ship.run(90.0);
  ASSERT_TRUE(products.rate);
  EXPECT_NEAR(products.rate->surge, 0.02, 1e-10);
  EXPECT_NEAR(products.rate->heel, radians(2.0 * kPerHour), 1e-12);
  EXPECT_NEAR(products.rate->trim, 0.0, 1e-12);
  // The middle lies 12 m off the axis that the hull heels about: that side rises by 12 cos(heel) a radian.
  const double middle = 1.3 * kPerHour - 12.0 * radians(2.0 * kPerHour);
  EXPECT_NEAR(products.rate->draft, middle, 0.002 * std::abs(middle) + 1e-6);
}

TEST(MotionProducts, GapsInHealthDoNotBendARate) {
  Ship ship([](double t) { return lying({0.02 * t, 0, -1.0 * kPerHour * t}, {0, 0, 0}); });
  ship.run(25.0);
  ship.run(8.0, false);
  const MotionProducts products = ship.run(4.0);
  ASSERT_TRUE(products.rate);
  EXPECT_NEAR(products.rate->surge, 0.02, 1e-10);
  EXPECT_NEAR(products.rate->draft, kPerHour, 1e-10);
}

TEST(MotionProducts, NothingIsKnownOfAnUnhealthyFrame) {
  Ship ship([](double) { return Pose::Identity(); });
  EXPECT_TRUE(ship.step(true).now);
  EXPECT_FALSE(ship.step(false).now);
}

TEST(MotionProducts, RatesNeedTwentySecondsOfHealthyPoses) {
  Ship ship([](double) { return Pose::Identity(); });
  ship.run(30.0, false);
  EXPECT_FALSE(ship.run(20.0).rate);  // the 200th pose comes 19.9 s after the first
  EXPECT_TRUE(ship.step().rate);
}

TEST(MotionProducts, AfterALongBlindSpellTheRecordBeginsAnew) {
  // Warped by 22 m meanwhile: no rate may tell of that.
  Ship ship([](double t) { return lying({t < 65.0 ? 0.0 : 22.0, 0, 0}, {0, 0, 0}); });
  EXPECT_TRUE(ship.run(60.0).rate);
  EXPECT_TRUE(ship.run(9.0, false).rate) << "a short spell takes nothing away";
  EXPECT_FALSE(ship.run(2.0, false).rate);
  EXPECT_FALSE(ship.run(20.0).rate);
  const MotionProducts products = ship.run(1.0);
  ASSERT_TRUE(products.rate);
  EXPECT_NEAR(products.rate->surge, 0.0, 1e-12);
}

TEST(MotionProducts, OnlyTheLastMinuteCounts) {
  Ship ship([](double t) { return lying({0, 0, t < 50.0 ? 0.1 * t : 5.0}, {0, 0, 0}); });
  EXPECT_GT(std::abs(ship.run(70.0).rate->draft), 1e-3);
  EXPECT_NEAR(ship.run(41.0).rate->draft, 0.0, 1e-12);
}

TEST(MotionProducts, WavesHardlyShowInTheRates) {
  // Leading term of the weighted slope of a swing: 210/pi^3 A P^3 / T^4; a quarter on top for the rest of the
  // series, which falls as P / T.
  constexpr double kHeave = 0.05;
  for (const double period : {6.3, 7.7, 9.1, 11.2, 13.9}) {
    Ship ship([=](double t) {
      return lying({0, 0, -kPerHour * t + kHeave * std::sin(2.0 * std::numbers::pi * t / period)}, {0, 0, 0});
    });
    ship.run(60.0);
    const double bound =
        1.25 * 210.0 / std::pow(std::numbers::pi, 3) * kHeave * std::pow(period, 3) / std::pow(60.0, 4);
    for (int i = 0; i < 150; ++i) {
      EXPECT_NEAR(ship.step().rate->draft, kPerHour, bound) << "period " << period;
    }
  }
}

TEST(MotionProducts, AClockThatRunsBackwardsBeginsAnotherRun) {
  MotionGauge gauge(kMapped);
  const auto at = [&](int tenth) {
    return gauge.update(MeasurementTime{milliseconds(100 * tenth)}, true, HullPose{});
  };
  for (int i = 0; i < 300; ++i) {
    (void)at(i);
  }
  EXPECT_FALSE(at(100).rate);
}

}  // namespace
}  // namespace hulltrack
