#include "lidar_drivers/sensor_clock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <tuple>

namespace hulltrack {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::HasSubstr;

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
  EXPECT_EQ(clock_words(clock.reading()), "2.9 ms ahead of this computer's");
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

std::string words(const SensorClock& clock) { return clock_words(clock.reading()); }

TEST(SensorClock, AnOffsetReadsInAUnitThatOneCanPicture) {
  EXPECT_EQ(offset_words(-microseconds(3200)), "3.2 ms behind");
  EXPECT_EQ(offset_words(seconds(37)), "37.0 s ahead");
  EXPECT_EQ(offset_words(-minutes(90)), "90.0 min behind");
  EXPECT_EQ(offset_words(hours(24)), "24.0 h ahead");
  EXPECT_EQ(offset_words(hours(24 * 100)), "100.0 days ahead");
  EXPECT_EQ(offset_words(-hours(8766 * 56)), "56.0 years behind");
  EXPECT_EQ(offset_words(Nanoseconds(std::int64_t{1} << 62)), "146.1 years ahead") << "as far as stamps go";
  EXPECT_EQ(offset_words(Nanoseconds(0)), "0.0 ms behind");
}

TEST(SensorClock, NamesWhatAWrongClockIsLikelyToRunOn) {
  EXPECT_THAT(words(listen(seconds(37))), HasSubstr("37.0 s ahead of this computer's: it runs on TAI"));
  EXPECT_THAT(words(listen(seconds(18))), HasSubstr("GPS"));
  EXPECT_THAT(words(listen(seconds(-1))), HasSubstr("leap second"));
  EXPECT_THAT(words(listen(hours(-3) - minutes(30))),
              HasSubstr("3.5 h behind this computer's: it keeps the"));
  EXPECT_THAT(words(listen(seconds(700) - kNow.time_since_epoch())),
              HasSubstr("56.0 years behind this computer's: it was never set, it has counted 11.7 min"));
  EXPECT_EQ(words(listen(seconds(123))), "123.0 s ahead of this computer's");
}

TEST(SensorClock, DriftIsToldInPartsPerMillionEitherWay) {
  EXPECT_THAT(words(listen(milliseconds(3), 50e-6, seconds(90))), HasSubstr("and gains "));
  EXPECT_THAT(words(listen(milliseconds(3), -50e-6, seconds(90))), HasSubstr("and loses "));
  EXPECT_THAT(words(listen(seconds(37), 5e-6, seconds(30))), HasSubstr(" ppm: it runs on TAI"));
}

TEST(SensorClock, WhatFollowsNothingIsNearByChance) {
  for (const auto& [reference, believed, says] :
       {std::tuple{ClockReference::unknown, true, "behind this computer's"},
        {ClockReference::ptp, true, "the sensor says that it follows PTP"},
        {ClockReference::gps, true, "follows GPS"},
        {ClockReference::pulse, true, "follows a pulse without a date"},
        {ClockReference::none, false,
         "behind this computer's; the sensor says that it is not synchronised"}}) {
    SensorClock clock(Nanoseconds::zero());
    clock.note(kNow.time_since_epoch(), kNow + milliseconds(1), reference);
    EXPECT_EQ(clock.believed(), believed) << says;
    EXPECT_EQ(clock.reading().believed(), believed) << says;
    EXPECT_THAT(words(clock), HasSubstr(says));
  }
}

TEST(SensorClock, OfAClockThatCountsAnHourOffsetsAreTakenModuloIt) {
  EXPECT_TRUE(listen(milliseconds(3), 0.0, seconds(3), hours(1)).believed());
  EXPECT_TRUE(listen(hours(5), 0.0, seconds(3), hours(1)).believed()) << "nobody can see that";
  EXPECT_THAT(words(listen(seconds(37), 0.0, seconds(3), hours(1))), HasSubstr("TAI"));
  EXPECT_THAT(words(listen(minutes(20), 0.0, seconds(3), hours(1))),
              HasSubstr("20.0 min ahead of this computer's: it is not synchronised in the 60.0 min"));
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
