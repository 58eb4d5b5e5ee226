#include "core/quay/quay_sight.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/quay_scene.hpp"

namespace hulltrack {
namespace {

using testing::quay_cloud;
using testing::quay_frame;
using testing::QuayFrame;

const Joints kWorking{0.0, radians(80.0), radians(-2.0)};

std::size_t count(const QuaySighting& sighting, SurfaceClass surface) {
  const auto& all = sighting.observed->all;
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [&](const QuayObservation& o) { return o.surface == surface; }));
}

/// A frame of `top` returns on the quay's top, and eight on the wall across the rails.
QuayFrame frame_with_little_wall(int top) {
  QuayFrame frame = quay_frame(kWorking, Pose::Identity(), 1, top, {0});
  for (int i = 0; i < 8; ++i) {
    frame.scan.returns_W.front().emplace_back(14.0F, -12.0F + 0.1F * static_cast<float>(i), 3.0F);
    frame.scan.of.front().push_back(ReturnOf::surroundings);
  }
  return frame;
}

TEST(QuaySight, OfAFewReturnsOfAWallAmongThousandsNoneIsPassedOver) {
  const QuayMap map(quay_cloud());
  QuaySight sight(true);
  const QuayFrame frame = frame_with_little_wall(2900);
  const QuaySighting& sighting = sight.look_for(map, frame.scan, {}, Pose::Identity());
  EXPECT_EQ(sight.returns_W().size(), 2908U);
  EXPECT_EQ(count(sighting, SurfaceClass::transverse), 8U);
}

TEST(QuaySight, OfAScanOfAnyNumberOfReturnsABoundedNumberIsAsked) {
  const QuayMap map(quay_cloud());
  QuaySight sight(true);
  const QuayFrame frame = frame_with_little_wall(50'000);
  std::size_t of_wall = 0;
  for (int i = 0; i < 20; ++i) {
    sight.forget();
    of_wall += count(sight.look_for(map, frame.scan, {}, Pose::Identity()), SurfaceClass::transverse);
    EXPECT_LE(sight.returns_W().size(), QuaySight::kLookedUp);
  }
  EXPECT_GE(of_wall, 4U) << "others are asked each frame: of 8 in 50,000 the twentieth part";
}

TEST(QuaySight, TheTopIsLookedForInItsArea) {
  QuaySight sight(true);
  const QuayFrame frame = quay_frame(kWorking, Pose::Identity(), 1, 280, {0});
  EXPECT_EQ(sight.look_for(QuayPlane{}, frame.scan).asked, 280U);
  const Box far_away{{100.0F, 100.0F, 0.0F}, {110.0F, 110.0F, 0.0F}};
  EXPECT_EQ(sight.look_for(QuayPlane{}, frame.scan, &far_away).asked, 0U);
}

TEST(QuaySight, PlanesAreLookedForWhereTheScanHasThem) {
  // A machine that has travelled half a metre farther than it says: rays pass the end of a wall along the
  // rails and meet what stands behind it.
  const QuayMap map(quay_cloud({0, 2}));
  const Pose E(Eigen::Translation3d(-0.5, 0.0, 0.0));
  const testing::QuaySurface behind{{14.15F, -24.0F, 1.0F}, {6.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 5.0F}};
  const auto seen_through = [&](const Pose& known) {
    QuaySight sight(true);
    std::size_t through = 0;
    for (unsigned i = 0; i < 20; ++i) {
      const QuayFrame frame = quay_frame(kWorking, E, i, 8000, {2}, {behind});
      const QuaySighting& sighting = sight.look_for(map, frame.scan, frame.views, known);
      through += sighting.planes[static_cast<std::size_t>(SurfaceClass::longitudinal)].seen_through_W.size();
    }
    return through;
  };
  const std::size_t unknown = seen_through(Pose::Identity());
  EXPECT_GT(unknown, 20U);
  EXPECT_LT(seen_through(E), unknown / 4);
}

}  // namespace
}  // namespace hulltrack
