#include "lidar_drivers/sensor_clock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace hulltrack {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr WallTime kNow{seconds(1'767'251'400)};

/// A sensor whose clock is `off` the host's and gains `drift` s/s, heard 1 kHz for `length`; each datagram is
/// received 0.1 ms late, and by an exponential delay of 0.5 ms on top.
SensorClock listen(Nanoseconds off, double drift = 0.0, Nanoseconds length = seconds(3),
                   Nanoseconds wrap = Nanoseconds::zero()) {
  SensorClock clock(wrap);
  std::mt19937 random(3);
  std::exponential_distribution<double> delay(1.0 / 500e3);
  for (Nanoseconds t{0}; t < length; t += milliseconds(1)) {
    const Nanoseconds late = microseconds(100) + Nanoseconds(static_cast<std::int64_t>(delay(random)));
    const Nanoseconds gained(static_cast<std::int64_t>(drift * static_cast<double>(t.count())));
    const Nanoseconds sensor = kNow.time_since_epoch() + t + off + gained;
    clock.note(wrap == Nanoseconds::zero() ? sensor : (sensor % wrap + wrap) % wrap, kNow + t + late);
  }
  return clock;
}

TEST(SensorClock, OffsetIsThatOfTheDatagramsThatWereNotDelayed) {
  const SensorClock clock = listen(milliseconds(3));
  EXPECT_NEAR(to_milliseconds(clock.offset()), 3.0 - 0.1, 0.01);
  EXPECT_TRUE(clock.believed());
  EXPECT_THAT(clock.suspicion(), IsEmpty());
}

TEST(SensorClock, OneLateDatagramIsNoReasonToDoubtIt) {
  SensorClock clock = listen(milliseconds(0));
  const WallTime late = kNow + seconds(3) + milliseconds(24);
  EXPECT_EQ(clock.note(kNow.time_since_epoch() + seconds(3), late), -milliseconds(24));
  EXPECT_TRUE(clock.believed());
}

TEST(SensorClock, DriftIsTheSlopeOfAMinute) {
  EXPECT_FALSE(listen(milliseconds(0), 50e-6, seconds(8)).drift());
  for (const double drift : {-50e-6, 0.0, 50e-6}) {
    const auto found = listen(milliseconds(0), drift, seconds(90)).drift();
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, drift, 1e-6);
  }
}

TEST(SensorClock, AClockThatIsSetBeginsAnew) {
  SensorClock clock = listen(milliseconds(0), 50e-6, seconds(30));
  clock.note(kNow.time_since_epoch() + seconds(30 + 37), kNow + seconds(30));
  EXPECT_FALSE(clock.believed());
  EXPECT_FALSE(clock.drift());
}

TEST(SensorClock, NamesWhatAWrongClockIsLikelyToRunOn) {
  EXPECT_THAT(listen(seconds(37)).suspicion(), HasSubstr("TAI"));
  EXPECT_THAT(listen(seconds(18)).suspicion(), HasSubstr("GPS"));
  EXPECT_THAT(listen(seconds(-1)).suspicion(), HasSubstr("leap second"));
  EXPECT_THAT(listen(hours(-3) - minutes(30)).suspicion(), HasSubstr("3.50 h behind"));
  EXPECT_THAT(listen(seconds(700) - kNow.time_since_epoch()).suspicion(), HasSubstr("never set"));
  EXPECT_THAT(listen(seconds(123)).suspicion(), HasSubstr("123.000 s ahead"));
}

TEST(SensorClock, OfAClockThatCountsAnHourOffsetsAreTakenModuloIt) {
  EXPECT_TRUE(listen(milliseconds(3), 0.0, seconds(3), hours(1)).believed());
  EXPECT_TRUE(listen(hours(5), 0.0, seconds(3), hours(1)).believed()) << "nobody can see that";
  EXPECT_THAT(listen(seconds(37), 0.0, seconds(3), hours(1)).suspicion(), HasSubstr("TAI"));
  EXPECT_THAT(listen(minutes(20), 0.0, seconds(3), hours(1)).suspicion(), HasSubstr("not synchronised"));
}

TEST(SensorClock, TheFullHourIsNoJump) {
  const Nanoseconds into_hour = kNow.time_since_epoch() % hours(1);
  SensorClock clock(hours(1));
  for (Nanoseconds t = hours(1) - into_hour - seconds(20); t < hours(1) - into_hour + seconds(20);
       t += milliseconds(10)) {
    clock.note((into_hour + t) % hours(1), kNow + t);
  }
  EXPECT_TRUE(clock.drift()) << "forty seconds in a row";
}

}  // namespace
}  // namespace hulltrack
