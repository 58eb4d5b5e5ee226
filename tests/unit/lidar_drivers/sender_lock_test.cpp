#include "lidar_drivers/sender_lock.hpp"

#include <gtest/gtest.h>

namespace hulltrack {
namespace {

constexpr std::uint32_t kA = 0xC0A801C9;
constexpr std::uint32_t kB = 0xC0A801CA;
constexpr std::uint32_t kC = 0xC0A801CB;

class SenderLockTest : public testing::Test {
 protected:
  /// A datagram that can be decoded if it is taken.
  bool send(std::uint32_t ip, double t) {
    const auto received = measurement_time_from_ns(static_cast<std::int64_t>(t * 1e9));
    const bool taken = lock.takes(ip, received);
    if (taken) lock.decoded(ip, received);
    return taken;
  }
  /// Ten a second, from one or from both by turns; how many of `ip` are taken.
  int run(double from, double until, std::initializer_list<std::uint32_t> senders, std::uint32_t ip) {
    int taken = 0;
    for (double t = from; t < until; t += 0.1) {
      for (const std::uint32_t sender : senders) taken += send(sender, t) && sender == ip ? 1 : 0;
    }
    return taken;
  }

  SenderLock lock{std::chrono::milliseconds(500)};
};

TEST_F(SenderLockTest, OneSensorIsNeverDisputed) {
  EXPECT_EQ(run(0.0, 9.95, {kA}, kA), 100);
  EXPECT_FALSE(lock.disputed());
  EXPECT_EQ(lock.dropped(), 0U);
}

TEST_F(SenderLockTest, ASecondOneBesideAFirstThatWasAloneIsDroppedForGood) {
  run(0.0, 3.0, {kA}, kA);
  EXPECT_EQ(run(3.0, 5.95, {kA, kB}, kB), 0);
  EXPECT_FALSE(lock.disputed());
  EXPECT_EQ(lock.first(), kA);
  EXPECT_EQ(lock.second(), kB);
  EXPECT_EQ(run(6.0, 60.0, {kB, kC}, kB) + run(60.0, 70.0, {kC}, kC), 0) << "the first is silent";
  EXPECT_TRUE(send(kA, 71.0));
}

TEST_F(SenderLockTest, TwoFromTheStartAreDisputedUntilOneHasBeenAlone) {
  EXPECT_EQ(run(0.0, 10.0, {kA, kB}, kB), 0) << "never mixed";
  EXPECT_TRUE(lock.disputed());
  run(10.0, 11.8, {kA}, kA);
  EXPECT_TRUE(lock.disputed());
  run(11.8, 13.0, {kA}, kA);
  EXPECT_FALSE(lock.disputed());
}

TEST_F(SenderLockTest, OfTwoFromTheStartTheOneThatGoesOnIsTakenOnceItWasAlone) {
  run(0.0, 10.0, {kA, kB}, kA);
  EXPECT_GT(run(10.0, 11.5, {kB}, kB), 5);
  EXPECT_TRUE(lock.disputed());
  run(11.5, 13.0, {kB}, kB);
  EXPECT_FALSE(lock.disputed());
  EXPECT_EQ(lock.first(), kB);
}

TEST_F(SenderLockTest, ASpareSensorTakesTheSilentOnesPlace) {
  run(0.0, 10.0, {kA}, kA);
  EXPECT_TRUE(send(kB, 20.0));
  EXPECT_FALSE(lock.disputed());
}

TEST_F(SenderLockTest, WhatCannotBeDecodedLocksNothing) {
  EXPECT_TRUE(lock.takes(kB, measurement_time_from_ns(1)));
  EXPECT_EQ(run(0.0, 3.0, {kA}, kA), 30);
  EXPECT_EQ(lock.first(), kA);
}

}  // namespace
}  // namespace hulltrack
