#include "core/localisation/bend_filter.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hulltrack {
namespace {

MeasurementTime at(int tenths) { return MeasurementTime{tenths * std::chrono::milliseconds(100)}; }

/// Frames first .. last - 1 that all say the same. Not inlined: GCC 12 would warn of the optional inside.
[[gnu::noinline]] void feed(BendFilter& filter, int first, int last, double d, double sigma) {
  for (int i = first; i < last; ++i) {
    filter.update(at(i), d, sigma);
  }
}

TEST(BendFilter, BeforeAnyFrameAHullIsStraightToAThousandthOfItsLength) {
  EXPECT_EQ(BendFilter(180.0).now().d, 0.0);
  EXPECT_DOUBLE_EQ(BendFilter(180.0).now().sigma, 0.18);
}

TEST(BendFilter, ConvergesToAConstantBendAndKnowsHowWell) {
  constexpr double kBend = 0.08;
  constexpr double kSigma = 0.05;
  int within = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, kSigma);
    BendFilter filter(180.0);
    double sigma = filter.now().sigma;
    for (int i = 0; i < 600; ++i) {
      filter.update(at(i), kBend + noise(random), kSigma);
      if (i < 100) {
        EXPECT_LT(filter.now().sigma, sigma) << i;
      }
      sigma = filter.now().sigma;
    }
    within += std::abs(filter.now().d - kBend) < 2.0 * filter.now().sigma ? 1 : 0;
    EXPECT_LT(filter.now().sigma, 0.02);
  }
  EXPECT_GE(within, 95) << "two sigma are 95 of a hundred, and independent noise is the best case";
}

TEST(BendFilter, FirstFrameIsWeighedAgainstWhatIsKnownOfHullsAsBayesHasIt) {
  BendFilter filter(100.0);
  filter.update(at(0), 0.06, 0.02);
  const double known = 1.0 / (0.1 * 0.1);
  const double told = 1.0 / (BendFilter::kShared * 0.02 * 0.02);
  EXPECT_NEAR(filter.now().d, 0.06 * told / (known + told), 1e-12);
  EXPECT_NEAR(filter.now().sigma, 1.0 / std::sqrt(known + told), 1e-12);
}

TEST(BendFilter, SettlesWhereWhatAFrameTellsIsWhatItForgets) {
  // Steady state of the Riccati equation: p^2 / (p + R) = Q, p before the frame, one frame every 0.1 s.
  constexpr double kSigma = 0.03;
  BendFilter filter(180.0);
  feed(filter, 0, 20'000, 0.0, kSigma);
  const double q = 0.1 * BendFilter::kWander * BendFilter::kWander;
  const double r = BendFilter::kShared * kSigma * kSigma;
  const double p = (q + std::sqrt(q * q + 4.0 * q * r)) / 2.0;
  EXPECT_NEAR(filter.now().sigma, std::sqrt(p - q), 1e-6);
}

TEST(BendFilter, IsNeverLessCertainThanAtFirst) {
  BendFilter filter(180.0);
  for (int hour = 0; hour < 100; ++hour) {
    filter.update(at(hour * 36'000), 0.05, 0.1);
    EXPECT_LE(filter.now().sigma, 0.18);
  }
  filter.update(at(100'000'000), 0.05, 1e6);
  EXPECT_LE(filter.now().sigma, 0.18);
}

TEST(BendFilter, FollowsABendThatChanges) {
  BendFilter filter(180.0);
  feed(filter, 0, 3000, 0.0, 0.02);
  feed(filter, 3000, 12'000, 0.1, 0.02);  // a hold filled in a quarter of an hour
  EXPECT_NEAR(filter.now().d, 0.1, 0.01);
}

TEST(BendFilter, FiguresThatAreNoneAreLeftOut) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  BendFilter filter(180.0);
  filter.update(at(0), 0.05, 0.02);
  const Bend before = filter.now();
  for (const auto& [d, sigma] : {std::pair{kNan, 0.02}, std::pair{kInfinity, 0.02}, std::pair{0.1, kNan},
                                 std::pair{0.1, kInfinity}, std::pair{0.1, 0.0}, std::pair{0.1, -0.02}}) {
    filter.update(at(10), d, sigma);
    EXPECT_EQ(filter.now().d, before.d) << d << ", " << sigma;
    EXPECT_EQ(filter.now().sigma, before.sigma) << d << ", " << sigma;
  }
}

TEST(BendFilter, TimeThatRunsBackwardsForgetsNothing) {
  BendFilter filter(180.0);
  filter.update(at(1000), 0.05, 0.02);
  const double sigma = filter.now().sigma;
  filter.update(at(0), 0.05, 0.02);
  EXPECT_LT(filter.now().sigma, sigma);
}

}  // namespace
}  // namespace hulltrack
