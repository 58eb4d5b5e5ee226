// Which returns lie near a direction, and what hides what lies there? Returns are put into chosen cells.
#include "core/sight/scan_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace hulltrack {
namespace {

using Cell = SphericalGrid::Cell;

constexpr Cell kCell{60, 200};  // 30 deg below the horizon
constexpr float kDeck = 20.0F;  // m

/// A point at `range` in the middle of a cell, or `u`, `v` of half a cell beside it.
Point in_cell(Cell cell, float range, double u = 0.0, double v = 0.0) {
  const double elevation = radians(cell.row - 90 + 0.5 + 0.5 * v);
  const double azimuth = radians(cell.column - 180 + 0.5 + 0.5 * u);
  return (range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation)))
      .cast<float>();
}

/// Returns in kCell at these ranges, seen from the origin.
ScanView seen(const std::vector<float>& ranges, Cell cell = kCell) {
  Cloud returns;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    returns.push_back(in_cell(cell, ranges[i], -0.8 + 0.3 * static_cast<double>(i % 6)));
  }
  ScanView view;
  view.rebuild(returns, Pose::Identity());
  return view;
}

TEST(ScanView, ARaindropBeforeADeckDoesNotHideIt) {
  const std::vector<float> drop_in_three{kDeck, 5.0F, kDeck};
  const std::vector<float> two_in_five{5.0F, kDeck, kDeck, 9.0F, kDeck};
  for (const std::vector<float>& ranges : {drop_in_three, two_in_five}) {
    const ScanView view = seen(ranges);
    EXPECT_FALSE(view.hidden(kCell, kDeck));
    EXPECT_FALSE(view.hidden(kCell.moved(0, 1), kDeck)) << "nor what lies beside it";
    EXPECT_TRUE(view.hidden(kCell, kDeck + 0.5F)) << "but the deck hides what is below it";
  }
}

TEST(ScanView, AChuteHidesWhatIsBehindItThoughADeckShowsBesideIt) {
  for (const std::vector<float>& ranges :
       {std::vector<float>{5.0F, 5.1F, 5.0F, 5.1F}, std::vector<float>{5.0F, 5.1F, 5.0F, kDeck}}) {
    const ScanView view = seen(ranges);
    EXPECT_TRUE(view.hidden(kCell, kDeck));
    for (int dr = -1; dr <= 1; ++dr) {
      for (int dc = -1; dc <= 1; ++dc) {
        EXPECT_TRUE(view.hidden(kCell.moved(dr, dc), kDeck)) << "beams are sparser than cells";
      }
    }
    EXPECT_FALSE(view.hidden(kCell.moved(0, 2), kDeck));
    EXPECT_FALSE(view.hidden(kCell.moved(2, 0), kDeck));
    EXPECT_FALSE(view.hidden(kCell, 4.9F)) << "what is nearer";
  }
}

TEST(ScanView, WhatIsBehindByALittleIsHiddenInItsOwnCellOnly) {
  const ScanView view = seen({10.0F, 10.0F, 10.0F});
  EXPECT_FALSE(view.hidden(kCell, 10.3F));
  EXPECT_TRUE(view.hidden(kCell, 10.5F));
  EXPECT_FALSE(view.hidden(kCell.moved(1, 0), 11.9F));
  EXPECT_TRUE(view.hidden(kCell.moved(1, 0), 12.1F));
}

TEST(ScanView, NeighboursLieAcrossTheSeamToo) {
  const ScanView view = seen({5.0F, 5.0F, 5.0F}, {60, SphericalGrid::kColumns - 1});
  EXPECT_TRUE(view.hidden({60, 0}, kDeck));
}

TEST(ScanView, NothingIsHiddenByTheScanBefore) {
  ScanView view = seen({5.0F, 5.0F, 5.0F});
  view.rebuild(Cloud{}, Pose::Identity());
  EXPECT_FALSE(view.hidden(kCell, kDeck));
  EXPECT_TRUE(view.returns(kCell).empty());
}

TEST(ScanView, ReturnsOfACellAreThoseInItsDirectionInTheFrameOfTheLidar) {
  const Pose T_W_L = pose_from_xyz_rpy_deg({3.0, -40.0, 17.0}, {5.0, 90.0, 30.0});
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(-15.0F, 15.0F);
  Cloud points_W;
  for (int i = 0; i < 20'000; ++i) {
    points_W.push_back(T_W_L.translation().cast<float>() + Point(u(random), u(random), u(random)));
  }
  ScanView view;
  view.rebuild(points_W, T_W_L);
  EXPECT_EQ(view.T_W_L().matrix(), T_W_L.matrix());
  std::size_t count = 0;
  for (std::size_t i = 0; i < SphericalGrid::kCells; ++i) {
    for (const Point& p_L : view.returns(SphericalGrid::at(i))) {
      EXPECT_EQ(SphericalGrid::cell(p_L).index(), i);
      ++count;
    }
  }
  EXPECT_EQ(count, points_W.size());
  std::size_t missing = 0;
  for (const Point& p_W : points_W) {
    const Point p_L = (T_W_L.inverse() * p_W.cast<double>()).cast<float>();
    const std::span<const Point> here = view.returns(SphericalGrid::cell(p_L));
    missing += std::any_of(here.begin(), here.end(), [&](const Point& p) { return (p - p_L).norm() < 1e-4F; })
                   ? 0
                   : 1;
  }
  EXPECT_LT(missing, 10U) << "on the border of two cells";
}

TEST(ScanView, LooksAtTheRowsBetweenAndTheColumnsThatEverHadAReturn) {
  ScanView view;
  EXPECT_FALSE(view.looks_at(kCell)) << "it has seen nothing yet";
  view.rebuild(Cloud{in_cell({50, 200}, 10.0F), in_cell({70, 203}, 10.0F)}, Pose::Identity());
  EXPECT_TRUE(view.looks_at({60, 200})) << "lasers may be more than a cell apart";
  EXPECT_TRUE(view.looks_at({60, 203}));
  EXPECT_FALSE(view.looks_at({60, 201}));
  EXPECT_FALSE(view.looks_at({49, 200}));
  EXPECT_FALSE(view.looks_at({71, 200}));
  view.rebuild(Cloud{in_cell({71, 201}, 10.0F)}, Pose::Identity());
  EXPECT_TRUE(view.looks_at({71, 201}));
  EXPECT_TRUE(view.looks_at({50, 200})) << "it only grows";
}

}  // namespace
}  // namespace hulltrack
