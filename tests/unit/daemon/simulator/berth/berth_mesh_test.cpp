#include "daemon/simulator/berth/berth_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/simulator/berth/loader_machine.hpp"
#include "daemon/simulator/berth/quay_ground.hpp"
#include "daemon/simulator/run/simulated_berth.hpp"
#include "daemon/simulator/sensing/ray_scene.hpp"

namespace hulltrack {
namespace {

std::unique_ptr<SimulatedBerth> parked_at(double d_x, double slew_deg, double luff_deg) {
  return std::move(SimulatedBerth::create({.scenario = "static",
                                           .frames = 1,
                                           .parked = Joints{d_x, radians(slew_deg), radians(luff_deg)}}))
      .value();
}

/// Returns of one frame from what is built at the berth.
struct Seen {
  int top = 0;     // of the quay
  int across = 0;  // faces that look along x
  int along = 0;   // faces that look along y
};

Seen seen_of_berth(const SimulatedBerth& berth, const RayScene& built) {
  const SimulatedLidar& lidar = berth.lidars().front();
  const Pose T_W_L = lidar_pose(loader_machine(), berth.true_joints(Nanoseconds{0}), lidar.mount());
  std::vector<sim::LaserFiring> firings;
  Seen seen;
  for (std::uint64_t packet = 0; packet < lidar.packets(); ++packet) {
    const auto returns = lidar.returns(packet);
    lidar.encoder().firings(packet, firings);
    for (std::size_t i = 0; i < returns.size(); ++i) {
      const Point origin = (T_W_L * firings[i].origin).cast<float>();
      const Point direction = (T_W_L.linear() * firings[i].direction).cast<float>();
      const auto hit = built.cast(origin, direction, 100.0F);
      if (!hit || std::abs(static_cast<double>(hit->distance) - returns[i].range) > 0.1) continue;
      const Point p = origin + hit->distance * direction;
      const Point n = hit->normal.cwiseAbs();
      if (n.z() > 0.99F && std::abs(p.z() - quay_top(p.x(), p.y())) < 0.05F) ++seen.top;
      if (n.x() > 0.9F) ++seen.across;
      if (n.y() > 0.9F) ++seen.along;
    }
  }
  return seen;
}

TEST(QuayGround, DrainsOnePerCentInlandUpToTheGutterAndIsUnevenByCentimetres) {
  float worst = 0.0F;
  for (float x = -150.0F; x <= 150.0F; x += 1.7F)
    for (float y = -28.0F; y <= 0.0F; y += 0.9F)
      worst = std::max(worst, std::abs(quay_top(x, y) - (-0.15F + 0.0005F * x + 0.01F * y)));
  EXPECT_LT(worst, 0.032F);
  EXPECT_GT(worst, 0.015F);
  EXPECT_GT(quay_top(0.0F, -70.0F), quay_top(0.0F, -28.0F) + 0.1F) << "the yard rises again";
}

TEST(QuayGround, ItsMeshIsItsHeight) {
  TriangleMesh mesh;
  add_quay_ground(mesh);
  const RayScene scene(mesh);
  for (float x = -159.3F; x < 159.0F; x += 3.7F)
    for (float y = -89.0F; y < -0.1F; y += 2.3F) {
      const auto hit = scene.cast({x, y, 50.0F}, {0.0F, 0.0F, -1.0F}, 100.0F);
      ASSERT_TRUE(hit);
      // Half a step of 2 m from the nearest corner: 1/8 of 2 m squared times the sines' curvature, 4 mm at
      // most.
      EXPECT_NEAR(50.0F - hit->distance, quay_top(x, y), 0.004F);
    }
}

/// Ten returns of 2 cm noise tell a place to 2 cm at three sigma.
TEST(BerthMesh, TheLidarOnTheBoomSeesEnoughOfTheBerthInAllThreeDirectionsFromEveryCornerOfTheWorkingRange) {
  constexpr int kEnough = 10;
  const RayScene built(berth_mesh());
  for (const double d_x : {-28.0, 1.0, 30.0})
    for (const double slew_deg : {56.0, 90.0, 124.0})
      for (const double luff_deg : {-5.0, 5.0}) {
        const Seen seen = seen_of_berth(*parked_at(d_x, slew_deg, luff_deg), built);
        EXPECT_GT(seen.top, 500) << d_x << ' ' << slew_deg << ' ' << luff_deg;
        EXPECT_GT(seen.across, kEnough) << d_x << ' ' << slew_deg << ' ' << luff_deg;
        EXPECT_GT(seen.along, kEnough) << d_x << ' ' << slew_deg << ' ' << luff_deg;
      }
}

TEST(QuayMap, LiesOnWhatIsBuiltAboveTheWaterOnePointAVoxelAndShowsEveryFaceThatASurveySees) {
  const auto berth = parked_at(0.0, 90.0, 0.0);
  const Cloud map = berth->quay_map();
  EXPECT_EQ(map, berth->quay_map());
  std::vector<std::array<int, 3>> voxels;
  int ground = 0;
  int towers = 0;
  for (const Point& p : map) {
    EXPECT_GT(p.z(), kWaterLevel);
    EXPECT_LT(p.y(), 1.03F) << "nothing of a ship";
    const Eigen::Vector3i voxel = (p / 0.1F).array().floor().cast<int>();
    voxels.push_back({voxel.x(), voxel.y(), voxel.z()});
    ground += std::abs(p.z() - quay_top(p.x(), p.y())) < 0.03F ? 1 : 0;
    towers += p.z() > 9.0F ? 1 : 0;
  }
  std::sort(voxels.begin(), voxels.end());
  EXPECT_EQ(std::adjacent_find(voxels.begin(), voxels.end()), voxels.end());
  EXPECT_GT(ground, 300'000);
  EXPECT_GT(towers, 10'000);
}

}  // namespace
}  // namespace hulltrack
