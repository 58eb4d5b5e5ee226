#include "daemon/simulator/berth/quay_traffic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulator/berth/loader_machine.hpp"
#include "daemon/simulator/berth/quay_ground.hpp"
#include "daemon/simulator/run/simulated_berth.hpp"

namespace hulltrack {
namespace {

constexpr float kEdgeStrip = -2.5F;  // the crane drives there
/// Feet of the portal, 0.5 m to either side of the rails.
bool in_the_portals_way(float y) { return std::abs(y + 3.0F) < 0.5F || std::abs(y + 13.5F) < 0.5F; }

TEST(QuayTraffic, IsTheSameForASeedAndAnotherForAnother) {
  EXPECT_EQ(parked_now(4).vertices, parked_now(4).vertices);
  EXPECT_NE(parked_now(4).vertices, parked_now(5).vertices);
  EXPECT_NE(parked_at_survey(4).vertices, parked_at_survey(5).vertices);
  EXPECT_NE(movers(4)[0].walk.T_W_own(0.0).translation().x(),
            movers(5)[0].walk.T_W_own(0.0).translation().x());
}

TEST(QuayTraffic, LeavesEdgeAndPortalTheirWayAndStandsOnTheGround) {
  std::size_t parked = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    for (const TriangleMesh& mesh : {parked_now(seed), parked_at_survey(seed)}) {
      parked += mesh.vertices.size();
      for (const Point& p : mesh.vertices) {
        EXPECT_LT(p.y(), kEdgeStrip);
        EXPECT_FALSE(in_the_portals_way(p.y())) << p.transpose();
        EXPECT_GT(p.z(), quay_top(p.x(), p.y()) - 0.15F);
      }
    }
    for (const Mover& mover : movers(seed))
      for (const double t : {0.0, 17.0, 60.0, 3000.0}) {
        const Pose T = mover.walk.T_W_own(t);
        for (const Point& p : mover.mesh.vertices) {
          const auto y = static_cast<float>((T * p.cast<double>()).y());
          EXPECT_LT(y, kEdgeStrip);
          EXPECT_FALSE(in_the_portals_way(y)) << y;
        }
      }
  }
  EXPECT_GT(parked, 10'000U) << "some quays are empty, not all";
}

/// Bodies are interpolated within a datagram: a jump would smear one over the quay.
TEST(QuayTraffic, NobodyJumpsAndEveryoneTurnsRound) {
  for (const Mover& mover : movers(7)) {
    double low = 1e9;
    double high = -1e9;
    for (double t = 0.0; t < 400.0; t += 0.05) {
      const double x = mover.walk.T_W_own(t).translation().x();
      EXPECT_LT((mover.walk.T_W_own(t + 0.05).translation() - mover.walk.T_W_own(t).translation()).norm(),
                0.22);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    EXPECT_GT(high - low, 90.0);
    EXPECT_LT(high, 121.0);
  }
}

/// Height in W of the first surface straight below (x, y) at time t.
float height(const SimulatedBerth& berth, double t, const Eigen::Vector3d& p) {
  constexpr double kFrom = 5.5;  // m, below the conveyor gallery
  const Pose& mount = berth.lidars().front().mount();
  const Pose T_L_W =
      lidar_pose(loader_machine(), berth.true_joints(nanoseconds_from_ms(t * 1e3)), mount).inverse();
  const Eigen::Vector3d origin = T_L_W * Eigen::Vector3d(p.x(), p.y(), kFrom);
  const Eigen::Vector3d down = T_L_W.linear() * Eigen::Vector3d(0.0, 0.0, -1.0);
  const auto hit = berth.world().cast(berth.world().sweep(mount, t, t + 0.001), t, origin.cast<float>(),
                                      down.cast<float>(), 200.0F);
  EXPECT_TRUE(hit);
  return static_cast<float>(kFrom) - (hit ? hit->distance : 0.0F);
}

TEST(QuayTraffic, IsInTheWorldWhereItIsAtThatTimeAndNotInTheMapOfTheQuay) {
  const auto berth =
      std::move(SimulatedBerth::create({.scenario = "static", .seed = 9, .frames = 1})).value();
  for (const Mover& mover : movers(9)) {
    const Eigen::Vector3d here = mover.walk.T_W_own(5.0).translation();
    const auto x = static_cast<float>(here.x());
    const auto y = static_cast<float>(here.y());
    EXPECT_GT(height(*berth, 5.0, here), quay_top(x, y) + 1.5F);
    EXPECT_NEAR(height(*berth, 25.0, here), quay_top(x, y), 0.3F);
  }
  const auto highest = [](const TriangleMesh& mesh) {
    return *std::ranges::max_element(mesh.vertices, {}, [](const Point& p) { return p.z(); });
  };
  const Point parked = highest(parked_now(9));
  const Point left = highest(parked_at_survey(9));
  const auto mapped_at = [map = berth->quay_map()](const Point& p) {
    return std::ranges::count_if(map, [&](const Point& q) { return (q - p).norm() < 0.5F; });
  };
  EXPECT_EQ(mapped_at(parked), 0);
  EXPECT_GT(mapped_at(left), 10);
  EXPECT_LT(height(*berth, 0.0, left.cast<double>()), left.z() - 1.0F);
}

}  // namespace
}  // namespace hulltrack
