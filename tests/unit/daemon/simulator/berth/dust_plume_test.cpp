#include "daemon/simulator/berth/dust_plume.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "daemon/simulator/run/scenario.hpp"

namespace hulltrack {
namespace {

/// Share of level beams through the middle of the plume that dust stops, and where.
double stopped_share(const DustPlume& plume, double t, float height, RandomStream& random) {
  const DustPlume::Now now = plume.at(t);
  constexpr int kBeams = 400;
  int stopped = 0;
  for (int i = 0; i < kBeams; ++i) {
    const Point origin = now.top_W + Point(-20.0F, static_cast<float>(random.uniform(-1.0, 1.0)), -height);
    const auto at = plume.stops(now, origin, {1.0F, 0.0F, 0.0F}, 40.0F, random);
    if (!at) continue;
    ++stopped;
    EXPECT_GT(*at, 20.0F - DustPlume::kBottomRadius - 0.5F);
    EXPECT_LT(*at, 20.0F + DustPlume::kBottomRadius + 0.5F);
  }
  return stopped / double{kBeams};
}

TEST(DustPlume, StopsTwentyToEightyPercentOfTheBeamsInsideWhilePouringAndComesAndGoes) {
  const LoaderMotion pouring(Joints{0.0, 1.5, 0.0});
  const DustPlume plume(find_scenario("dust")->dust, pouring, 7);
  RandomStream random(1, 1);
  std::vector<double> shares;
  for (double t = 0.0; t < 60.0; t += 1.5) shares.push_back(stopped_share(plume, t, 11.0F, random));
  std::sort(shares.begin(), shares.end());
  EXPECT_GT(shares[shares.size() / 10], 0.2);
  EXPECT_LT(shares[shares.size() * 9 / 10], 0.8);
  EXPECT_GT(shares.back() - shares.front(), 0.15) << "no puffs";
}

TEST(DustPlume, SettlesWhileTheLoaderMoves) {
  const LoaderMotion loader(loader_limits(), 120.0, 5);
  const DustPlume plume(1.0, loader, 7);
  double most = 0.0;
  double least = 1.0;
  for (double t = 0.0; t < 120.0; t += 0.25) {
    const double strength = plume.at(t).strength;
    most = std::max(most, strength);
    least = std::min(least, strength);
    EXPECT_LE(std::abs(plume.at(t + 0.01).strength - strength), 0.26);  // never all at once
  }
  EXPECT_EQ(most, 1.0);
  EXPECT_EQ(least, 0.0);
}

TEST(DustPlume, NeighbouringBeamsMeetTheSamePuffAndDistantTimesDoNot) {
  const LoaderMotion pouring(Joints{0.0, 1.5, 0.0});
  const DustPlume plume(0.8, pouring, 7);
  RandomStream random(1, 2);
  // Correlation of the stopped share with itself after 0.1 s and after 20 s.
  std::vector<double> now, soon, late;
  for (double t = 0.0; t < 120.0; t += 1.7) {
    now.push_back(stopped_share(plume, t, 11.0F, random));
    soon.push_back(stopped_share(plume, t + 0.1, 11.0F, random));
    late.push_back(stopped_share(plume, t + 20.0, 11.0F, random));
  }
  const auto correlation = [](const std::vector<double>& a, const std::vector<double>& b) {
    const auto n = static_cast<Eigen::Index>(a.size());
    const Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(a.data(), n);
    const Eigen::ArrayXd y = Eigen::Map<const Eigen::ArrayXd>(b.data(), n);
    const Eigen::ArrayXd dx = x - x.mean();
    const Eigen::ArrayXd dy = y - y.mean();
    return (dx * dy).sum() / std::sqrt(dx.square().sum() * dy.square().sum());
  };
  EXPECT_GT(correlation(now, soon), 0.7);
  EXPECT_LT(correlation(now, late), 0.4);
}

TEST(DustPlume, BeamsBesideAboveAndShortOfThePlumePass) {
  const LoaderMotion pouring(Joints{0.0, 1.5, 0.0});
  const DustPlume plume(1e6, pouring, 7);
  const DustPlume::Now now = plume.at(3.0);
  RandomStream random(1, 3);
  const Point top = now.top_W;
  for (int i = 0; i < 200; ++i) {
    EXPECT_FALSE(plume.stops(now, top + Point(-20, 8.5F, -5), {1, 0, 0}, 40.0F, random));
    EXPECT_FALSE(plume.stops(now, top + Point(-20, 0, 0.5F), {1, 0, 0}, 40.0F, random));
    EXPECT_FALSE(plume.stops(now, top + Point(-20, 0, -5), {1, 0, 0}, 11.0F, random));
    EXPECT_FALSE(plume.stops(now, top + Point(0, 0, -17.5F), {0, 0, -1}, 40.0F, random));
  }
  EXPECT_TRUE(plume.stops(now, top + Point(-20, 0.3F, -6), {1, 0, 0}, 40.0F, random));
}

}  // namespace
}  // namespace hulltrack
